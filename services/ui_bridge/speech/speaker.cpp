#include "services/ui_bridge/speech/speaker.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace beckon::ui_bridge::speech {
namespace {

constexpr Utime kPoll_us = 20'000;

/// A file without a name that holds `bytes`, at its beginning; -1 where that fails. A child can
/// read it at its own pace, and nobody waits for it.
int MemoryFile(const std::vector<uint8_t>& bytes) {
  const int fd = memfd_create("prompt", MFD_CLOEXEC);
  if (fd < 0) return -1;
  size_t written = 0;
  while (written < bytes.size()) {
    const ssize_t n = write(fd, bytes.data() + written, bytes.size() - written);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    written += static_cast<size_t>(n);
  }
  if (written == bytes.size() && lseek(fd, 0, SEEK_SET) == 0) return fd;
  close(fd);
  return -1;
}

}  // namespace

Speaker::Speaker(SpeakerConfig config, RunLoop& loop, Callbacks callbacks)
    : config_(std::move(config)),
      loop_(loop),
      callbacks_(std::move(callbacks)),
      self_(std::make_shared<Speaker*>(this)),
      worker_(std::make_unique<LatestWorker<Request>>([this](const Request& r) { Make(r); })) {}

Speaker::~Speaker() {
  worker_.reset();
  *self_ = nullptr;
  if (watched_) loop_.RemoveFd(child_->ended_fd());
  if (poll_) loop_.Cancel(*poll_);
}

void Speaker::Say(const std::string& text) {
  Hush();
  if (text.empty()) return;
  making_ = true;
  worker_->Offer({++number_, text});
}

void Speaker::Hush() {
  ++number_;
  making_ = false;
  if (!child_) return;
  if (std::exchange(watched_, false)) loop_.RemoveFd(child_->ended_fd());
  child_->Kill();
  End(/*whole=*/false);
}

/// In the worker's thread: espeak-ng takes its time.
void Speaker::Make(const Request& request) {
  auto wave = SpeakToWave(config_.espeak, request.text);
  std::vector<int16_t> samples;
  if (wave) samples = AtSampleRate(*wave);
  loop_.Post([self = self_, number = request.number, wave = std::move(wave),
              samples = std::move(samples)] {
    if (*self != nullptr) (*self)->Play(number, wave, samples);
  });
}

void Speaker::Play(int64_t number, const Result<Wave>& wave, const std::vector<int16_t>& samples) {
  if (number != number_) return;
  making_ = false;
  if (!wave) return Fail(wave.error().message);
  if (config_.play.empty()) return callbacks_.over(true);
  const int input = MemoryFile(WriteWave(*wave));
  if (input < 0) return Fail(std::string("a prompt in memory: ") + std::strerror(errno));
  auto child = Child::Start(config_.play, {.input = input});
  close(input);
  if (!child) return Fail(child.error().message);
  child_ = *std::move(child);
  if (child_->ended_fd() >= 0) {
    loop_.AddFd(child_->ended_fd(), [this] { CheckEnd(); });
    watched_ = true;
  } else {
    poll_ = loop_.Every(kPoll_us, [this] { CheckEnd(); });
  }
  callbacks_.begun(samples);
}

void Speaker::CheckEnd() {
  if (!child_ || !child_->Ended()) return;
  if (std::exchange(watched_, false)) loop_.RemoveFd(child_->ended_fd());
  const int code = child_->Wait();
  if (code != 0) {
    Fail(config_.play.front() + ": ended with code " + std::to_string(code));
  } else {
    failure_.clear();
  }
  End(code == 0);
}

void Speaker::End(bool whole) {
  if (poll_) loop_.Cancel(*std::exchange(poll_, std::nullopt));
  child_.reset();
  callbacks_.over(whole);
}

void Speaker::Fail(const std::string& reason) {
  if (std::exchange(failure_, reason) != reason) callbacks_.failed(reason);
}

}  // namespace beckon::ui_bridge::speech
