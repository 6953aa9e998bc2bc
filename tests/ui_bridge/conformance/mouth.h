// A mouth: espeak-ng speaks into a FIFO in the microphone's place, which hears a quiet room
// besides.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <deque>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "services/base/run_loop.h"
#include "services/ui_bridge/speech/acoustics.h"
#include "services/ui_bridge/speech/espeak.h"

namespace beckon::ui_bridge::conformance {

class Mouth {
 public:
  /// Makes the FIFO. Throws where that fails.
  explicit Mouth(std::string path) : path_(std::move(path)) {
    unlink(path_.c_str());
    if (mkfifo(path_.c_str(), 0600) != 0) throw std::runtime_error(path_ + ": no FIFO");
    microphone_ = open(path_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  }
  ~Mouth() {
    close(microphone_);
    unlink(path_.c_str());
  }
  Mouth(const Mouth&) = delete;
  Mouth& operator=(const Mouth&) = delete;

  const std::string& path() const { return path_; }

  /// From now on the microphone hears the room. The loop may not outlive the mouth.
  void Open(RunLoop& loop) {
    loop.Every(kBeat_us, [this] { Beat(); });
  }

  /// After what it is saying, and `silence_s`. Throws without espeak-ng.
  void Say(const std::string& text, const std::string& voice = "en-us", double silence_s = 0) {
    auto known = said_.find({text, voice});
    if (known == said_.end()) {
      auto wave = speech::SpeakToWave({.voice = voice}, text);
      if (!wave) throw std::runtime_error(wave.error().message);
      known = said_.emplace(std::pair(text, voice), speech::AtSampleRate(*wave)).first;
    }
    to_say_.insert(to_say_.end(), static_cast<size_t>(silence_s * speech::kSampleRate), 0);
    for (const int16_t x : known->second) to_say_.push_back(static_cast<int16_t>(x / 2));
  }

 private:
  static constexpr Utime kBeat_us = 50'000;
  static constexpr size_t kBeatSamples = speech::kSampleRate / 20;

  void Beat() {
    std::normal_distribution<double> room(0, 12);
    std::vector<int16_t> beat(kBeatSamples);
    for (auto& x : beat) {
      x = static_cast<int16_t>(room(random_));
      if (to_say_.empty()) continue;
      x = static_cast<int16_t>(x + to_say_.front());
      to_say_.pop_front();
    }
    [[maybe_unused]] const auto written = write(microphone_, beat.data(), 2 * beat.size());
  }

  const std::string path_;
  int microphone_ = -1;
  std::mt19937_64 random_{1};
  std::deque<int16_t> to_say_;
  std::map<std::pair<std::string, std::string>, std::vector<int16_t>> said_;
};

}  // namespace beckon::ui_bridge::conformance
