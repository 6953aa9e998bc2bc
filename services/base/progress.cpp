// Lines on standard error.
#include "services/base/progress.h"

#include <cstdio>
#include <utility>

namespace beckon {

Progress::Progress(bool terminal, std::function<bool()> stopped)
    : terminal_(terminal), stopped_(std::move(stopped)) {}

bool Progress::Tell(const std::string& step, size_t done, size_t total) {
  constexpr auto kRedraw = std::chrono::milliseconds(100);
  constexpr auto kNewLine = std::chrono::seconds(10);
  const auto now = Clock::now();
  const bool begins = step != step_;
  if (begins) {
    EndLine();
    step_ = step;
    began_ = now;
  }
  const bool due =
      begins || now - told_ >= (terminal_ ? kRedraw : kNewLine) || (terminal_ && done == total);
  if (due) {
    told_ = now;
    const std::string text =
        ProgressText(step, done, total, std::chrono::duration<double>(now - began_).count());
    std::fprintf(stderr, terminal_ ? "\r\033[K%s" : "%s\n", text.c_str());
    std::fflush(stderr);
    line_open_ = terminal_;
  }
  return !stopped();
}

void Progress::Say(const std::string& text) {
  EndLine();
  std::fprintf(stderr, "%s\n", text.c_str());
}

void Progress::EndLine() {
  if (line_open_) std::fputc('\n', stderr);
  line_open_ = false;
}

std::string ProgressText(const std::string& step, size_t done, size_t total, double seconds) {
  if (total == 0) return step;
  char text[64];
  const double part = static_cast<double>(done) / static_cast<double>(total);
  if (done == 0 || done == total || seconds < 1) {  // too early, or too late, for the time
    std::snprintf(text, sizeof(text), " %.0f %%", 100 * part);
  } else {
    const int left = static_cast<int>(seconds / part * (1 - part) + 0.5);
    std::snprintf(text, sizeof(text), " %.0f %%, %d:%02d left", 100 * part, left / 60, left % 60);
  }
  return step + text;
}

}  // namespace beckon
