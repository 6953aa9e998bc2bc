// A mouth: espeak-ng speaks into a FIFO in the microphone's place, which hears a quiet room
// besides.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <deque>
#include <map>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "services/ui_bridge/speech/espeak.h"
#include "tests/ui_bridge/conformance/hand.h"

namespace beckon::ui_bridge::conformance {

class SpeechHand : public Hand {
 public:
  SpeechHand() {
    unlink(path_.c_str());
    if (mkfifo(path_.c_str(), 0600) != 0) throw std::runtime_error(path_ + ": no FIFO");
    microphone_ = open(path_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  }
  ~SpeechHand() override {
    close(microphone_);
    unlink(path_.c_str());
  }

  std::string front_end() const override { return "speech"; }
  /// Prompts are made, and played in no time.
  std::string config() const override {
    return "[speech]\ninput = \"" + path_ + "\"\nask_again_s = 0\nplay = [\"true\"]\n";
  }
  double patience_s() const override { return 20; }

  void Begin(const HandSetup& setup) override {
    setup_.emplace(setup);
    setup.loop.Every(kBeat_us, [this] { Beat(); });
    setup.bus.Subscribe<msg::Answer>([this](const msg::Answer&) { unheard_.clear(); });
    setup.bus.Subscribe<msg::Session>([this](const msg::Session& session) {
      if (session.kind < msg::SessionKind::kIdle) unheard_.clear();
    });
  }
  void Start() override { Say("start"); }
  size_t Choose(const msg::Query& query, size_t option) override {
    Say(query.options[option].text);
    return option;
  }
  bool Stop() override { return Say("stop"); }
  bool Resume() override { return Say("resume"); }
  bool Undo() override { return Say("undo"); }

 protected:
  const std::string& path() const { return path_; }
  /// Says it again where it leads to nothing, as a person does.
  bool Say(const std::string& text) {
    Utter(text);
    unheard_ = text;
    setup_->loop.After(kPatience_us, [this, text] {
      if (unheard_ == text) Utter(text);
      unheard_.clear();
    });
    return true;
  }

 private:
  void Utter(const std::string& text) {
    auto known = said_.find(text);
    if (known == said_.end()) {
      auto wave = speech::SpeakToWave({}, text);
      if (!wave) throw std::runtime_error(wave.error().message);
      known = said_.emplace(text, speech::AtSampleRate(*wave)).first;
    }
    // A breath, so that what was said before has an end.
    to_say_.insert(to_say_.end(), kBreathSamples, 0);
    for (const int16_t x : known->second) to_say_.push_back(static_cast<int16_t>(x / 2));
  }

  static constexpr Utime kPatience_us = 6 * kSecond;
  static constexpr Utime kBeat_us = 50'000;
  static constexpr size_t kBeatSamples = 800;  // at 16 kHz
  static constexpr size_t kBreathSamples = 40'000;

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

  const std::string path_ = "/tmp/beckon-mouth-" + std::to_string(getpid());
  int microphone_ = -1;
  std::optional<HandSetup> setup_;
  std::string unheard_;  // what was said, and led to nothing yet
  std::mt19937_64 random_{1};
  std::deque<int16_t> to_say_;
  std::map<std::string, std::vector<int16_t>> said_;
};

}  // namespace beckon::ui_bridge::conformance
