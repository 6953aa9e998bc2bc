#include "services/ui_bridge/speech/espeak.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "services/base/utime.h"
#include "services/ui_bridge/child.h"

namespace beckon::ui_bridge::speech {
namespace {

constexpr int kTimeout_ms = 10'000;
constexpr size_t kMostOutput = 64U << 20;
constexpr size_t kLongestText = 4'000;

/// Text that begins with a dash would be an option, and control characters are none of speech.
std::string Speakable(std::string text) {
  text.resize(std::min(text.size(), kLongestText));
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == '<' || c == '[') c = ' ';
  }
  return " " + text;
}

}  // namespace

Result<std::vector<uint8_t>> OutputOf(const std::vector<std::string>& command, int timeout_ms) {
  auto child = Child::Start(command, {.pipe_output = true});
  if (!child) return child.error();
  std::vector<uint8_t> output;
  const SteadyClock clock;
  const Utime deadline = clock.Now() + Utime{timeout_ms} * 1000;
  std::array<uint8_t, 65536> bytes{};
  for (;;) {
    pollfd ready{child->output(), POLLIN, 0};
    const auto left_ms = static_cast<int>((deadline - clock.Now()) / 1000);
    if (left_ms <= 0 || output.size() > kMostOutput) {
      return Error{command.front() + ": no end after " + std::to_string(timeout_ms) +
                   " ms; it was killed"};
    }
    if (poll(&ready, 1, left_ms) <= 0) continue;
    const ssize_t n = read(child->output(), bytes.data(), bytes.size());
    if (n < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (n <= 0) break;
    output.insert(output.end(), bytes.begin(), bytes.begin() + n);
  }
  if (const int code = child->Wait(); code != 0)
    return Error{command.front() + ": ended with code " + std::to_string(code)};
  return output;
}

Result<Wave> SpeakToWave(const EspeakConfig& config, const std::string& text) {
  auto bytes =
      OutputOf({config.program, "-v", config.voice, "-s", std::to_string(config.words_per_minute),
                "-p", std::to_string(config.pitch), "-a", std::to_string(config.volume), "--stdout",
                "--", Speakable(text)},
               kTimeout_ms);
  if (!bytes) return bytes.error();
  return ReadWave(*bytes);
}

Result<Pronunciation> PronounceByEspeak(const EspeakConfig& config, const std::string& word,
                                        const std::string& accent) {
  auto bytes = OutputOf(
      {config.program, "-q", "-x", "--sep=_", "-v", accent, "--", Speakable(word)}, kTimeout_ms);
  if (!bytes) return bytes.error();
  return FromEspeak(std::string(bytes->begin(), bytes->end()));
}

}  // namespace beckon::ui_bridge::speech
