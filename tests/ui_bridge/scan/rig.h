// A scanner with a clock of its own and a user who does as told; keeps what happened.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "services/ui_bridge/scan/scanner.h"

namespace beckon::ui_bridge::scan {

constexpr Utime kMs = 1000;

/// Plain times that are easy to reckon with.
inline Config PlainConfig() {
  Config config;
  config.scan_us = 1000 * kMs;
  config.first_us = 500 * kMs;
  config.ignore_repeat_us = 0;
  config.debounce_us = 0;
  config.guard_us = 0;
  config.press_us = 100 * kMs;
  return config;
}

inline Page Options(int n, std::vector<double> probabilities = {}) {
  return {.id = 1, .n_options = n, .probabilities = std::move(probabilities)};
}

class Rig {
 public:
  explicit Rig(const Config& config) : scanner(config) {}

  void Show(const Page& page) { scanner.Show(now, page); }

  /// Lets time pass, ticking as the scanner asks for it.
  void Wait(Utime time) { Until(now + time); }
  void Until(Utime end) {
    while (StepTo(end)) {
    }
    now = end;
  }
  /// To the next deadline that is not after `end`; false where there is none.
  bool StepTo(Utime end) {
    const auto due = scanner.NextDeadline();
    if (!due || *due > end) return false;
    now = std::max(now, *due);
    Take(scanner.Tick(now));
    return true;
  }
  void Down(Switch which = Switch::kMain) { Take(scanner.OnSwitch(now, which, true)); }
  void Up(Switch which = Switch::kMain) { Take(scanner.OnSwitch(now, which, false)); }
  void Click(Switch which = Switch::kMain) { Take(scanner.OnClick(now, which)); }
  void Press(Utime length, Switch which = Switch::kMain) {
    Down(which);
    Wait(length);
    Up(which);
  }
  void Take(const std::vector<Action>& taken) {
    for (const Action& action : taken) actions.emplace_back(now, action);
  }

  int Count(Action::Kind kind) const {
    return static_cast<int>(std::ranges::count_if(
        actions, [kind](const auto& timed) { return timed.second.kind == kind; }));
  }
  /// Options chosen so far.
  std::vector<int> Chosen() const {
    std::vector<int> chosen;
    for (const auto& [at, action] : actions) {
      if (action.kind == Action::Kind::kChoose) chosen.push_back(action.option);
    }
    return chosen;
  }

  Scanner scanner;
  Utime now = 0;
  std::vector<std::pair<Utime, Action>> actions;
};

}  // namespace beckon::ui_bridge::scan
