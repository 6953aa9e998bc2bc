#include "services/ui_bridge/web/settings.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace beckon::ui_bridge::web {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kMostShown = 60;  // characters of what was found

/// Reads the keys of one object and remembers the first that is wrong.
class Reader {
 public:
  Reader(const Json& json, std::string prefix) : json_(json), prefix_(std::move(prefix)) {
    if (!json.is_object()) error_ = Error{prefix_ + ": expected an object"};
  }

  void Choice(const char* key, std::string& value, const std::vector<std::string>& choices) {
    const Json* found = Find(key);
    if (found == nullptr) return;
    const bool right =
        found->is_string() && std::ranges::count(choices, found->get<std::string>()) > 0;
    if (right) {
      value = found->get<std::string>();
      return;
    }
    std::string expected;
    for (const auto& choice : choices) expected += (expected.empty() ? "" : ", ") + choice;
    Fail(key, "one of " + expected, *found);
  }

  /// `zero`: 0 is right as well.
  void Number(const char* key, double& value, double least, double most, bool zero = false) {
    const Json* found = Find(key);
    if (found == nullptr) return;
    const double number = found->is_number() ? found->get<double>() : NAN;
    if ((number >= least && number <= most) || (zero && number == 0)) {
      value = number;
    } else {
      Fail(key, (zero ? "0 or " : "") + Short(least) + " to " + Short(most), *found);
    }
  }

  void Integer(const char* key, int& value, int least, int most) {
    const Json* found = Find(key);
    if (found == nullptr) return;
    const double number = found->is_number() ? found->get<double>() : NAN;
    if (number >= least && number <= most && number == std::floor(number)) {
      value = static_cast<int>(number);
    } else {
      Fail(key, "a whole number from " + std::to_string(least) + " to " + std::to_string(most),
           *found);
    }
  }

  void Bool(const char* key, bool& value) {
    const Json* found = Find(key);
    if (found == nullptr) return;
    if (found->is_boolean()) {
      value = found->get<bool>();
    } else {
      Fail(key, "true or false", *found);
    }
  }

  /// "auto", or letters and digits with hyphens: a language tag (BCP 47).
  void Language(const char* key, std::string& value) {
    const Json* found = Find(key);
    if (found == nullptr) return;
    const std::string tag = found->is_string() ? found->get<std::string>() : "";
    const bool right = tag.size() >= 2 && tag.size() <= 35 && tag.front() != '-' &&
                       tag.back() != '-' && std::ranges::all_of(tag, [](char c) {
                         return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                                (c >= '0' && c <= '9') || c == '-';
                       });
    if (right) {
      value = tag;
    } else {
      Fail(key, "auto or a language, e.g. de", *found);
    }
  }

  /// The object of a key, or null.
  const Json* Part(const char* key) {
    const Json* found = Find(key);
    if (found != nullptr && !found->is_object()) Fail(key, "an object", *found);
    return found != nullptr && found->is_object() ? found : nullptr;
  }

  /// Call last: what nobody asked for is wrong too.
  std::optional<Error> Finish() {
    for (auto entry = json_.begin(); !error_ && json_.is_object() && entry != json_.end();
         ++entry) {
      if (!known_.contains(entry.key()))
        error_ = Error{"'" + prefix_ + entry.key().substr(0, kMostShown) + "': no such setting"};
    }
    return error_;
  }

 private:
  const Json* Find(const char* key) {
    known_.insert(key);
    if (!json_.is_object()) return nullptr;
    const auto found = json_.find(key);
    return found == json_.end() ? nullptr : &*found;
  }

  void Fail(const char* key, const std::string& expected, const Json& found) {
    if (error_) return;
    std::string text = found.dump(-1, ' ', /*ensure_ascii=*/true, Json::error_handler_t::replace);
    if (text.size() > kMostShown) text = text.substr(0, kMostShown) + "...";
    error_ = Error{"'" + prefix_ + key + "': expected " + expected + ", found " + text};
  }

  static std::string Short(double value) { return Json(value).dump(); }

  const Json& json_;
  const std::string prefix_;
  std::set<std::string> known_;
  std::optional<Error> error_;
};

std::optional<Error> ReadScan(const Json& json, ScanSettings& scan) {
  Reader reader(json, "scan.");
  reader.Choice("method", scan.method, {"automatic", "step", "inverse"});
  reader.Choice("grouping", scan.grouping, {"linear", "row_column", "binary"});
  reader.Number("scan_time_s", scan.scan_time_s, 0.2, 20);
  reader.Number("first_item_delay_s", scan.first_item_delay_s, 0, 10);
  reader.Number("hold_s", scan.hold_s, 0, 5);
  reader.Number("ignore_repeat_s", scan.ignore_repeat_s, 0, 5);
  reader.Integer("rounds", scan.rounds, 0, 20);
  reader.Number("stop_hold_s", scan.stop_hold_s, 0.5, 20, /*zero=*/true);
  return reader.Finish();
}

std::optional<Error> ReadShow(const Json& json, Settings& settings) {
  Reader reader(json, "show.");
  reader.Bool("picture", settings.show_picture);
  reader.Bool("shapes", settings.show_shapes);
  return reader.Finish();
}

std::map<std::string, Settings> MakePresets() {
  std::map<std::string, Settings> presets;
  for (const char* name : {"pointer", "keyboard", "one_switch", "two_switches", "gaze"})
    presets[name].access = name;
  presets["two_switches"].scan.method = "step";
  // Gaze is less exact than a mouse, and rests where it reads.
  presets["gaze"].dwell_s = 1.2;
  presets["gaze"].text_percent = 150;
  presets["one_switch"].text_percent = 130;
  presets["two_switches"].text_percent = 130;
  return presets;
}

Utime Microseconds(double seconds) { return std::llround(seconds * 1e6); }

}  // namespace

Result<Settings> ReadSettings(const Json& json, const Settings& base) {
  Settings settings = base;
  Reader reader(json, "");
  reader.Choice("access", settings.access,
                {"pointer", "keyboard", "one_switch", "two_switches", "gaze"});
  reader.Choice("theme", settings.theme, {"auto", "light", "dark", "contrast"});
  reader.Integer("text_percent", settings.text_percent, 100, 250);
  reader.Language("language", settings.language);
  reader.Choice("motion", settings.motion, {"auto", "reduced", "full"});
  reader.Number("dwell_s", settings.dwell_s, 0.3, 5, /*zero=*/true);
  const Json* show = reader.Part("show");
  const Json* scan = reader.Part("scan");
  if (auto error = reader.Finish()) return *error;
  if (show != nullptr) {
    if (auto error = ReadShow(*show, settings)) return *error;
  }
  if (scan != nullptr) {
    if (auto error = ReadScan(*scan, settings.scan)) return *error;
  }
  if (auto right = scan::Validate(ScanConfig(settings)); !right)
    return Error{"'scan': " + right.error().message};
  return settings;
}

Json ToJson(const Settings& settings) {
  const ScanSettings& scan = settings.scan;
  return {{"access", settings.access},
          {"theme", settings.theme},
          {"text_percent", settings.text_percent},
          {"language", settings.language},
          {"motion", settings.motion},
          {"show", {{"picture", settings.show_picture}, {"shapes", settings.show_shapes}}},
          {"dwell_s", settings.dwell_s},
          {"scan",
           {{"method", scan.method},
            {"grouping", scan.grouping},
            {"scan_time_s", scan.scan_time_s},
            {"first_item_delay_s", scan.first_item_delay_s},
            {"hold_s", scan.hold_s},
            {"ignore_repeat_s", scan.ignore_repeat_s},
            {"rounds", scan.rounds},
            {"stop_hold_s", scan.stop_hold_s}}}};
}

const std::map<std::string, Settings>& Presets() {
  static const std::map<std::string, Settings> presets = MakePresets();
  return presets;
}

scan::Config ScanConfig(const Settings& settings) {
  const ScanSettings& scan = settings.scan;
  scan::Config config;
  config.method = scan.method == "step"      ? scan::Method::kStep
                  : scan.method == "inverse" ? scan::Method::kInverse
                                             : scan::Method::kAutomatic;
  config.step_select = settings.access == "two_switches" ? scan::StepSelect::kSecondSwitch
                                                         : scan::StepSelect::kDwell;
  config.grouping = scan.grouping == "binary"       ? scan::Grouping::kBinary
                    : scan.grouping == "row_column" ? scan::Grouping::kRowColumn
                                                    : scan::Grouping::kLinear;
  config.scan_us = config.dwell_us = Microseconds(scan.scan_time_s);
  config.first_us = Microseconds(scan.first_item_delay_s);
  config.hold_us = Microseconds(scan.hold_s);
  config.ignore_repeat_us = Microseconds(scan.ignore_repeat_s);
  config.stop_hold_us = Microseconds(scan.stop_hold_s);
  config.rounds = scan.rounds;
  // The page's keys do not bounce; key repeat is dropped by the page and by the server.
  config.debounce_us = 0;
  return config;
}

}  // namespace beckon::ui_bridge::web
