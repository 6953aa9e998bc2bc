#include "services/ui_bridge/scan/scan_config.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace beckon::ui_bridge::scan {
namespace {

template <typename T>
using Words = std::vector<std::pair<const char*, T>>;

template <typename T>
void GetWord(ConfigTable& table, const std::string& key, T& value, const Words<T>& words) {
  std::vector<std::string> choices;
  std::string word;
  for (const auto& [name, meaning] : words) {
    choices.emplace_back(name);
    if (meaning == value) word = name;
  }
  table.Get(key, word, choices);
  for (const auto& [name, meaning] : words) {
    if (word == name) value = meaning;
  }
}

void GetTime(ConfigTable& table, const std::string& key, Utime& value_us, double min, double max) {
  double seconds = static_cast<double>(value_us) / kSecond;
  table.Get(key, seconds, min, max);
  value_us = std::llround(seconds * kSecond);
}

}  // namespace

void ReadScanConfig(ConfigTable table, Config& config) {
  GetWord<Method>(
      table, "method", config.method,
      {{"automatic", Method::kAutomatic}, {"step", Method::kStep}, {"inverse", Method::kInverse}});
  GetWord<StepSelect>(table, "select", config.step_select,
                      {{"second-switch", StepSelect::kSecondSwitch},
                       {"dwell", StepSelect::kDwell},
                       {"long-press", StepSelect::kLongPress}});
  GetWord<Grouping>(table, "grouping", config.grouping,
                    {{"linear", Grouping::kLinear},
                     {"row-column", Grouping::kRowColumn},
                     {"binary", Grouping::kBinary}});
  GetWord<Order>(table, "order", config.order,
                 {{"likeliest", Order::kLikeliest}, {"given", Order::kGiven}});
  GetWord<Back>(table, "back", config.back, {{"pass", Back::kPass}, {"entry", Back::kEntry}});
  GetWord<Accept>(table, "accept", config.accept,
                  {{"release", Accept::kRelease}, {"press", Accept::kPress}});
  GetWord<ResumeBy>(table, "resume", config.resume_by,
                    {{"twice", ResumeBy::kTwice}, {"hold", ResumeBy::kHold}});
  GetTime(table, "scan_time", config.scan_us, 0.05, 60);
  GetTime(table, "first_delay", config.first_us, 0, 60);
  GetTime(table, "hold_time", config.hold_us, 0, 10);
  GetTime(table, "ignore_repeat", config.ignore_repeat_us, 0, 10);
  GetTime(table, "debounce", config.debounce_us, 0, 1);
  GetTime(table, "guard_time", config.guard_us, 0, 5);
  GetTime(table, "dwell_time", config.dwell_us, 0.05, 60);
  GetTime(table, "long_press", config.long_press_us, 0.05, 10);
  GetTime(table, "stop_hold", config.stop_hold_us, 0, 60);
  GetTime(table, "resume_hold", config.resume_hold_us, 0.2, 60);
  table.Get("rounds", config.rounds, 0, 100);
  table.Get("group_passes", config.group_passes, 1, 100);
  table.Get("columns", config.columns, 0, 64);
  table.Get("control_share", config.control_share, 0, 1);
  GetTime(table, "reaction_time", config.reaction_us, 0, 60);
  GetTime(table, "press_time", config.press_us, 0, 60);
  if (const Status right = Validate(config); !right) table.Fail("stop_hold", right.error().message);
}

}  // namespace beckon::ui_bridge::scan
