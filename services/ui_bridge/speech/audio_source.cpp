#include "services/ui_bridge/speech/audio_source.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace beckon::ui_bridge::speech {
namespace {

constexpr Utime kFilePeriod_us = 50'000;
constexpr size_t kFileBytes = 1'600;  // of that time
constexpr int kMostReads = 16;        // at once: others want to be served as well

}  // namespace

AudioSource::AudioSource(AudioSourceConfig config, RunLoop& loop, Callbacks callbacks)
    : config_(std::move(config)), loop_(loop), callbacks_(std::move(callbacks)) {}

AudioSource::~AudioSource() { CloseAll(); }

void AudioSource::Start() {
  wait_s_ = config_.retry_s;
  Open();
}

void AudioSource::Open() {
  std::string reason;
  if (!config_.input.empty()) {
    if (!OpenInput(reason)) Fail(reason);
    return;
  }
  auto child = Child::Start(config_.command, {.pipe_output = true});
  if (!child) return Fail(child.error().message);
  child_ = *std::move(child);
  fd_ = child_->output();
  loop_.AddFd(fd_, [this] { Read(); });
  watched_ = true;
}

bool AudioSource::OpenInput(std::string& reason) {
  fd_ = open(config_.input.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  own_fd_ = fd_ >= 0;
  struct stat status {};
  if (fd_ < 0 || fstat(fd_, &status) != 0) {
    reason = config_.input + ": " + std::strerror(errno);
    return false;
  }
  if (S_ISDIR(status.st_mode)) {
    reason = config_.input + ": is a folder; expected a file or FIFO of 16 bit samples at 16 kHz";
    return false;
  }
  if (S_ISREG(status.st_mode)) {  // cannot be waited for, and is read as fast as it was recorded
    timer_ = loop_.Every(kFilePeriod_us, [this] { ReadFile(); });
    return true;
  }
  loop_.AddFd(fd_, [this] { Read(); });
  watched_ = true;
  return true;
}

void AudioSource::Read() {
  std::array<uint8_t, 8192> bytes{};
  for (int i = 0; i < kMostReads; ++i) {
    const ssize_t n = read(fd_, bytes.data(), bytes.size());
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (n <= 0) {
      const std::string name = config_.input.empty() ? config_.command.front() : config_.input;
      return Fail(name + (n < 0 ? std::string(": ") + std::strerror(errno) : ": ended"));
    }
    Take({bytes.data(), static_cast<size_t>(n)});
    if (fd_ < 0) return;
  }
}

void AudioSource::ReadFile() {
  std::array<uint8_t, kFileBytes> bytes{};
  const ssize_t n = read(fd_, bytes.data(), bytes.size());
  if (n > 0) return Take({bytes.data(), static_cast<size_t>(n)});
  if (n < 0 && errno == EINTR) return;
  Fail(config_.input + ": ended");
}

void AudioSource::Take(std::span<const uint8_t> bytes) {
  if (!std::exchange(running_, true)) {
    told_ = false;
    wait_s_ = config_.retry_s;
    callbacks_.state(true, "");
  }
  std::vector<int16_t> samples;
  samples.reserve(bytes.size() / 2 + 1);
  for (const uint8_t byte : bytes) {
    if (!odd_) {
      odd_ = byte;
      continue;
    }
    samples.push_back(static_cast<int16_t>(*odd_ | (byte << 8)));
    odd_.reset();
  }
  callbacks_.samples(samples);
}

void AudioSource::Fail(const std::string& reason) {
  CloseAll();
  ++failures_;
  running_ = false;
  if (!std::exchange(told_, true)) callbacks_.state(false, reason);
  timer_ = loop_.After(static_cast<Utime>(wait_s_ * kSecond), [this] {
    timer_.reset();
    Open();
  });
  wait_s_ = std::min(2 * wait_s_, config_.retry_most_s);
}

void AudioSource::CloseAll() {
  if (timer_) loop_.Cancel(*std::exchange(timer_, std::nullopt));
  if (std::exchange(watched_, false)) loop_.RemoveFd(fd_);
  if (std::exchange(own_fd_, false)) close(fd_);
  fd_ = -1;
  child_.reset();
  odd_.reset();
}

}  // namespace beckon::ui_bridge::speech
