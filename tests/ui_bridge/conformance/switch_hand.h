// Presses one switch when what it wants is lit: a FIFO in the input device's place.
#pragma once

#include <fcntl.h>
#include <linux/input.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "tests/ui_bridge/conformance/hand.h"

namespace beckon::ui_bridge::conformance {

class SwitchHand : public Hand {
 public:
  SwitchHand() {
    unlink(path_.c_str());
    if (mkfifo(path_.c_str(), 0600) != 0) throw std::runtime_error(path_ + ": no FIFO");
    fd_ = open(path_.c_str(), O_RDWR | O_CLOEXEC);
  }
  ~SwitchHand() override {
    close(fd_);
    unlink(path_.c_str());
  }

  std::string front_end() const override { return "switch"; }
  std::vector<std::string> flags() const override { return {"--switch-device", path_}; }
  std::string config() const override {
    return "[switch]\nscan_time = 0.12\nfirst_delay = 0.05\nguard_time = 0.01\n"
           "ignore_repeat = 0.01\nstop_hold = 0.3\nrounds = 0\nsuggest = false\n";
  }

  void Begin(const HandSetup& setup) override {
    setup_.emplace(setup);
    setup_->bus.Subscribe<msg::Highlight>([this](const msg::Highlight& lit) {
      if (lit.device == setup_->device) Look(lit);
    });
    setup_->bus.Subscribe<msg::Answer>([this](const msg::Answer& answer) {
      if (answer.query_id == query_id_) option_ = -1;
    });
  }
  void Start() override { control_ = "start"; }
  size_t Choose(const msg::Query& query, size_t option) override {
    control_.clear();
    query_id_ = query.id;
    option_ = static_cast<int>(option);
    if (lit_) Look(*lit_);
    return option;
  }
  bool Stop() override {
    Forget();
    Press(kStopHold_us);
    return true;
  }
  bool Resume() override {
    control_ = "resume";
    return true;
  }
  bool Undo() override {
    control_ = "undo";
    return true;
  }

 protected:
  /// From lit to press, and how long a press lasts.
  virtual Utime reaction_us() const { return 20'000; }
  virtual Utime press_us() const { return 20'000; }

 private:
  static constexpr Utime kStopHold_us = 2'200'000;

  void Forget() {
    control_.clear();
    option_ = -1;
  }

  bool Wanted(const msg::Highlight& lit) const {
    if (!control_.empty()) return std::ranges::find(lit.controls, control_) != lit.controls.end();
    return lit.query_id == query_id_ &&
           std::ranges::find(lit.options, option_) != lit.options.end();
  }

  /// A press for each time that it lights up; what is lit on is not pressed again.
  void Look(const msg::Highlight& lit) {
    const bool news = !lit_ || lit.options != lit_->options || lit.controls != lit_->controls ||
                      lit.query_id != lit_->query_id || lit.paused != lit_->paused;
    lit_ = lit;
    if (!news && acted_on_this_) return;
    const bool wants = option_ >= 0 || !control_.empty();
    acted_on_this_ = wants && Act(Wanted(lit) || lit.paused);
  }

 protected:
  /// Does what the method asks for, now that what is wanted is lit or is not; false: nothing.
  virtual bool Act(bool wanted) {
    if (!wanted) return false;
    PressSoon();
    return true;
  }
  void PressSoon() {
    setup_->loop.After(reaction_us(), [this] { Press(press_us()); });
  }
  void Send(int value) {
    for (const uint16_t type : {EV_KEY, EV_SYN}) {
      input_event event{};
      event.type = type;
      event.code = type == EV_KEY ? KEY_SPACE : SYN_REPORT;
      event.value = type == EV_KEY ? value : 0;
      if (write(fd_, &event, sizeof event) != sizeof event)
        throw std::runtime_error("the switch is stuck");
    }
  }
  std::optional<HandSetup> setup_;

 private:
  void Press(Utime length_us) {
    Send(1);
    setup_->loop.After(length_us, [this] { Send(0); });
  }

  const std::string path_ = "/tmp/beckon-switch-" + std::to_string(getpid());
  int fd_ = -1;
  std::optional<msg::Highlight> lit_;
  bool acted_on_this_ = false;
  int64_t query_id_ = 0;
  int option_ = -1;      // wanted; -1 = none
  std::string control_;  // wanted; empty = none
};

}  // namespace beckon::ui_bridge::conformance
