// The hands at a person's pace, and at the front ends' own settings: for measuring how long things
// take.
#pragma once

#include "tests/ui_bridge/conformance/bci_hand.h"
#include "tests/ui_bridge/conformance/speech_hand.h"
#include "tests/ui_bridge/conformance/switch_hand.h"
#include "tests/ui_bridge/conformance/web_hand.h"

namespace beckon::ui_bridge::conformance {

/// One switch, as it comes; `more` are lines of its configuration.
class PacedSwitch : public SwitchHand {
 public:
  explicit PacedSwitch(std::string more = {}) : more_(std::move(more)) {}
  std::string config() const override { return "[switch]\nsuggest = false\n" + more_; }
  double patience_s() const override { return 120; }

 protected:
  Utime reaction_us() const override { return 450'000; }
  Utime press_us() const override { return 150'000; }

 private:
  const std::string more_;
};

class RowColumnSwitch final : public PacedSwitch {
 public:
  RowColumnSwitch() : PacedSwitch("grouping = \"row-column\"\n") {}
};

class BinarySwitch final : public PacedSwitch {
 public:
  BinarySwitch() : PacedSwitch("grouping = \"binary\"\n") {}
};

/// A press moves the pointer on; resting chooses.
class StepSwitch final : public PacedSwitch {
 public:
  StepSwitch() : PacedSwitch("method = \"step\"\nselect = \"dwell\"\n") {}

 protected:
  bool Act(bool wanted) override {
    if (!wanted) PressSoon();
    return true;
  }
};

/// The pointer moves while the switch is held; letting go chooses.
class InverseSwitch final : public PacedSwitch {
 public:
  InverseSwitch() : PacedSwitch("method = \"inverse\"\n") {}

 protected:
  bool Act(bool wanted) override {
    if (!held_) HoldSoon(true, reaction_us());
    if (wanted) HoldSoon(false, held_ ? reaction_us() : reaction_us() + press_us());
    return true;
  }

 private:
  void HoldSoon(bool down, Utime delay_us) {
    setup_->loop.After(delay_us, [this, down] {
      held_ = down;
      Send(down ? 1 : 0);
    });
  }
  bool held_ = false;
};

/// Decoded at the trials' own pace, as surely as a decoder that is right seven times of ten.
class PacedBci final : public BciHand {
 public:
  std::string config() const override {
    return "[bci]\nlearn = false\ncalibration_dir = \"/tmp/beckon-bci-hand\"\n";
  }
  double patience_s() const override { return 120; }

 protected:
  double sureness() const override { return 0.7; }
  Utime trial_us() const override { return 3 * kSecond; }
};

/// Hears prompts for as long as they take, but answers when it wants.
class PacedSpeech final : public SpeechHand {
 public:
  std::string config() const override {
    // A player without a sound card: takes as long as the sound (16 bits at 22,050 Hz).
    return "[speech]\ninput = \"" + path() +
           "\"\nplay = [\"perl\", \"-e\", \"local $/; my $w = <STDIN>; "
           "select(undef, undef, undef, length($w) / 44100)\"]\n";
  }
};

}  // namespace beckon::ui_bridge::conformance
