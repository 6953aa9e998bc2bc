// How one person uses the page: way of access, look, scanning. Read strictly, so that a setting
// that cannot be kept is told and not half done.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "services/base/result.h"
#include "services/ui_bridge/scan/config.h"

namespace beckon::ui_bridge::web {

struct ScanSettings {
  std::string method = "automatic";  // "step", "inverse"
  std::string grouping = "linear";   // "row_column", "binary"
  double scan_time_s = 1.5;          // s, an item is lit; 0.2 .. 20
  double first_item_delay_s = 0.8;   // s, more for the first; 0 .. 10
  double hold_s = 0;                 // s, a shorter press does not count; 0 .. 5
  double ignore_repeat_s = 0.3;      // s, nor does one sooner after the last; 0 .. 5
  int rounds = 3;                    // without a press, then it rests; 0 = never; .. 20
  double stop_hold_s = 2;            // s, holding is a stop; 0 = not; else 0.5 .. 20

  bool operator==(const ScanSettings&) const = default;
};

struct Settings {
  std::string access = "pointer";  // "keyboard", "one_switch", "two_switches", "gaze"
  std::string theme = "auto";      // "light", "dark", "contrast"
  int text_percent = 100;          // 100 .. 250
  std::string language = "auto";   // or a language tag, e.g. "de"
  std::string motion = "auto";     // "reduced", "full"
  bool show_picture = true;
  bool show_shapes = true;
  double dwell_s = 0;  // s, resting on a button clicks it; 0 = not; else 0.3 .. 5
  ScanSettings scan;

  /// The page is scanned with one or two switches.
  bool scans() const { return access == "one_switch" || access == "two_switches"; }
  bool operator==(const Settings&) const = default;
};

/// What is absent is as in `base`. An error names the key, what was expected and what was found.
Result<Settings> ReadSettings(const nlohmann::ordered_json& json, const Settings& base = {});
nlohmann::ordered_json ToJson(const Settings& settings);

/// By name of the way of access: what suits it.
const std::map<std::string, Settings>& Presets();

/// With two switches, stepping is by one and choosing by the other.
scan::Config ScanConfig(const Settings& settings);

}  // namespace beckon::ui_bridge::web
