#include "services/ui_bridge/scan/pace.h"

#include <algorithm>

namespace beckon::ui_bridge::scan {

Utime Pace::Choose_us(int entry, int depth) const {
  switch (config_.method) {
    case Method::kAutomatic:
      return Gap_us(Waited_us(entry) + Reaction_us(config_), depth) + Press_us();
    case Method::kStep:
      return Step_us(entry, depth, false);
    case Method::kInverse:
      return Inverse_us(entry, depth);
  }
  return 0;
}

Utime Pace::ChooseLast_us(int entry, int depth) const {
  switch (config_.method) {
    case Method::kAutomatic:
      return Gap_us(Waited_us(entry) + Reaction_us(config_), depth) + Accept_us();
    case Method::kStep:
      return Step_us(entry, depth, true);
    case Method::kInverse:
      return Inverse_us(entry, depth);
  }
  return 0;
}

Utime Pace::Gap_us(Utime wanted, int depth) const {
  // A level within a page begins when the release was debounced.
  const Utime least =
      depth == 0 ? config_.guard_us : config_.ignore_repeat_us - config_.debounce_us;
  return std::max(wanted, least);
}

Utime Pace::Press_us() const {
  return std::max({config_.press_us, config_.hold_us, config_.debounce_us}) + config_.debounce_us;
}

Utime Pace::Accept_us() const {
  return config_.accept == Accept::kRelease ? Press_us()
                                            : std::max(config_.hold_us, config_.debounce_us);
}

Utime Pace::Waited_us(int entry) const {
  return entry > 0 ? config_.first_us + entry * config_.scan_us : 0;
}

Utime Pace::Moves_us(int presses, int depth) const {
  Utime time = 0;
  for (int i = 0; i < presses; ++i) {
    time += Gap_us(Reaction_us(config_), i == 0 ? depth : 1) + Press_us();
  }
  return time;
}

Utime Pace::Step_us(int entry, int depth, bool last) const {
  const int choose_depth = entry == 0 ? depth : 1;
  switch (config_.step_select) {
    case StepSelect::kSecondSwitch:
      return Moves_us(entry, depth) + Gap_us(Reaction_us(config_), choose_depth) +
             (last ? Accept_us() : Press_us());
    case StepSelect::kLongPress:
      return Moves_us(entry, depth) + Gap_us(Reaction_us(config_), choose_depth) +
             std::max(config_.long_press_us, config_.debounce_us) + config_.debounce_us;
    case StepSelect::kDwell: {
      // The last press lies the dwell time back when a group opens.
      const Utime spared =
          depth == 0
              ? 0
              : Gap_us(Reaction_us(config_), depth) -
                    std::max(Reaction_us(config_),
                             config_.ignore_repeat_us - config_.debounce_us - config_.dwell_us);
      return Moves_us(entry + 1, depth) - spared + config_.dwell_us;
    }
  }
  return 0;
}

Utime Pace::Inverse_us(int entry, int depth) const {
  return Gap_us(Reaction_us(config_), depth) + std::max(config_.hold_us, config_.debounce_us) +
         Waited_us(entry) + Reaction_us(config_) + config_.debounce_us;
}

}  // namespace beckon::ui_bridge::scan
