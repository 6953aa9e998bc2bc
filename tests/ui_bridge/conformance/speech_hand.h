// A person who answers by speaking (mouth.h).
#pragma once

#include <unistd.h>

#include <optional>
#include <string>

#include "tests/ui_bridge/conformance/hand.h"
#include "tests/ui_bridge/conformance/mouth.h"

namespace beckon::ui_bridge::conformance {

class SpeechHand : public Hand {
 public:
  std::string front_end() const override { return "speech"; }
  /// Prompts are made, and played in no time.
  std::string config() const override {
    return "[speech]\ninput = \"" + path() + "\"\nask_again_s = 0\nplay = [\"true\"]\n";
  }
  double patience_s() const override { return 20; }

  void Begin(const HandSetup& setup) override {
    setup_.emplace(setup);
    mouth_.Open(setup.loop);
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
  const std::string& path() const { return mouth_.path(); }
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
  static constexpr Utime kPatience_us = 6 * kSecond;
  static constexpr double kBreath_s = 2.5;  // what was said before has an end

  void Utter(const std::string& text) { mouth_.Say(text, "en-us", kBreath_s); }

  Mouth mouth_{"/tmp/beckon-mouth-" + std::to_string(getpid())};
  std::optional<HandSetup> setup_;
  std::string unheard_;  // what was said, and led to nothing yet
};

}  // namespace beckon::ui_bridge::conformance
