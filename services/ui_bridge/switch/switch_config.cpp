#include "services/ui_bridge/switch/switch_config.h"

#include <algorithm>

#include "services/ui_bridge/scan/scan_config.h"

namespace beckon::ui_bridge {

void ReadSwitchConfig(ConfigTable table, SwitchConfig& config) {
  scan::ReadScanConfig(table, config.scan);
  table.Get("device", config.device);
  table.Get("key", config.key);
  table.Get("select_device", config.select_device);
  table.Get("select_key", config.select_key);
  table.Get("grab", config.grab);
  table.Get("max_options", config.max_options, 2, 64);
  table.Get("false_yes", config.false_yes, 0, 0.5);
  table.Get("false_no", config.false_no, 0, 0.5);
  table.Get("audio", config.audio);
  table.Get("voice", config.voice);
  table.Get("seconds_a_letter", config.seconds_a_letter, 0, 1);
  table.Get("suggest", config.suggest);
  if (config.voice.empty()) table.Fail("voice", "expected a program and its arguments");
  for (const auto& [key, text] :
       {std::pair{"key", config.key}, {"select_key", config.select_key}}) {
    if (const auto parsed = ParseKey(text); !parsed) table.Fail(key, parsed.error().message);
  }
}

bool TellsRelease(const SwitchConfig& config) { return config.device != "terminal"; }

Status ValidateSwitch(const SwitchConfig& config) {
  using scan::Method;
  using scan::StepSelect;
  if (const Status right = scan::Validate(config.scan); !right) return right;
  for (const auto& key : {config.key, config.select_key}) {
    if (const auto parsed = ParseKey(key); !parsed) return parsed.error();
  }
  if (config.device.empty()) return Error{"device: expected \"terminal\", a path or name:TEXT"};
  const bool step = config.scan.method == Method::kStep;
  if (!TellsRelease(config)) {
    const bool long_press = step && config.scan.step_select == StepSelect::kLongPress;
    if (config.scan.method == Method::kInverse || long_press) {
      return Error{
          "a terminal's key tells no release: method \"inverse\" and select \"long-press\" need a "
          "device (/dev/input/...)"};
    }
    if (config.scan.resume_by == scan::ResumeBy::kHold) {
      return Error{"a terminal's key cannot be held: expected resume = \"twice\""};
    }
    return {};
  }
  const bool second = !config.select_device.empty() || !config.select_key.empty();
  if (step && config.scan.step_select == StepSelect::kSecondSwitch && !second) {
    return Error{
        "select \"second-switch\" needs select_key or select_device; with one switch take "
        "\"dwell\" or \"long-press\""};
  }
  return {};
}

std::vector<EventDeviceConfig> EventDevices(const SwitchConfig& config) {
  const KeyChoice main = ParseKey(config.key).value();
  const KeyChoice select = ParseKey(config.select_key).value();
  if (config.select_device.empty()) {
    return {{.device = config.device, .main = main, .select = select, .grab = config.grab}};
  }
  const KeyChoice any{KeyChoice::kAny};
  return {{.device = config.device, .main = main, .select = {}, .grab = config.grab},
          {.device = config.select_device,
           .main = {},
           .select = config.select_key.empty() ? any : select,
           .grab = config.grab}};
}

}  // namespace beckon::ui_bridge
