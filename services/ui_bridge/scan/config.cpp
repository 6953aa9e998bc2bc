#include "services/ui_bridge/scan/config.h"

#include <string>

namespace beckon::ui_bridge::scan {
namespace {

constexpr Utime kMs = 1000;

struct Range {
  const char* name;
  Utime value;
  Utime least;
  Utime most;
};

std::string Seconds(Utime us) {
  std::string text = std::to_string(static_cast<double>(us) / kSecond);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text + " s";
}

Error Disorder(const std::string& what, Utime shorter, Utime longer) {
  return {what + ": expected the first to be shorter, found " + Seconds(shorter) + " and " +
          Seconds(longer)};
}

}  // namespace

Utime Reaction_us(const Config& config) {
  return config.reaction_us > 0 ? config.reaction_us : config.scan_us * 65 / 100;
}

Status Validate(const Config& config) {
  const Range ranges[] = {
      {"scan time", config.scan_us, 50 * kMs, 60 * kSecond},
      {"first delay", config.first_us, 0, 60 * kSecond},
      {"hold time", config.hold_us, 0, 10 * kSecond},
      {"ignore-repeat time", config.ignore_repeat_us, 0, 10 * kSecond},
      {"debounce time", config.debounce_us, 0, kSecond},
      {"guard time", config.guard_us, 0, 5 * kSecond},
      {"dwell time", config.dwell_us, 50 * kMs, 60 * kSecond},
      {"long press", config.long_press_us, 50 * kMs, 10 * kSecond},
      {"stop by holding", config.stop_hold_us, 0, 60 * kSecond},
      {"resume by holding", config.resume_hold_us, 200 * kMs, 60 * kSecond},
      {"reaction time", config.reaction_us, 0, 60 * kSecond},
      {"length of a press", config.press_us, 0, 60 * kSecond},
  };
  for (const Range& range : ranges) {
    if (range.value < range.least || range.value > range.most) {
      return Error{std::string(range.name) + ": expected " + Seconds(range.least) + " to " +
                   Seconds(range.most) + ", found " + Seconds(range.value)};
    }
  }
  if (config.rounds < 0 || config.rounds > 100) return Error{"rounds: expected 0 to 100"};
  if (config.group_passes < 1 || config.group_passes > 100) {
    return Error{"passes in a group: expected 1 to 100"};
  }
  if (config.columns < 0 || config.columns > 64) return Error{"columns: expected 0 to 64"};
  if (!(config.control_share >= 0 && config.control_share <= 1)) {
    return Error{"share of controls: expected 0 to 1"};
  }
  const bool long_press =
      config.method == Method::kStep && config.step_select == StepSelect::kLongPress;
  if (long_press && config.hold_us >= config.long_press_us) {
    return Disorder("hold time and long press", config.hold_us, config.long_press_us);
  }
  if (config.stop_hold_us == 0) return {};
  if (config.stop_hold_us < 200 * kMs) {
    return Error{"stop by holding: expected 0 (none) or at least 0.2 s, found " +
                 Seconds(config.stop_hold_us)};
  }
  if (config.hold_us >= config.stop_hold_us) {
    return Disorder("hold time and stop by holding", config.hold_us, config.stop_hold_us);
  }
  if (long_press && config.long_press_us >= config.stop_hold_us) {
    return Disorder("long press and stop by holding", config.long_press_us, config.stop_hold_us);
  }
  return {};
}

}  // namespace beckon::ui_bridge::scan
