// The settings of front end "switch": section [switch] of the configuration file.
#pragma once

#include <string>
#include <vector>

#include "services/base/config.h"
#include "services/base/result.h"
#include "services/ui_bridge/scan/config.h"
#include "services/ui_bridge/switch/event_device.h"

namespace beckon::ui_bridge {

struct SwitchConfig {
  scan::Config scan;
  std::string device = "terminal";  // or as EventDeviceConfig::device
  std::string key = "any";          // ParseKey
  std::string select_device;        // of a second switch; empty = none
  std::string select_key;           // its key; of the one device where there is no second
  bool grab = false;
  int max_options = 6;      // of a question
  double false_yes = 0.02;  // 0 .. 0.5
  double false_no = 0.02;   // 0 .. 0.5
  bool audio = false;
  std::vector<std::string> voice{"espeak-ng", "-s", "170"};  // a program and its arguments
  double seconds_a_letter = 0.06;  // of a question that is spoken, before the pointer moves on
  bool suggest = true;             // another scan time, between sessions
};

void ReadSwitchConfig(ConfigTable table, SwitchConfig& config);

/// Whether these settings work together: a second switch where one is needed, a release where the
/// method needs one.
Status ValidateSwitch(const SwitchConfig& config);

/// Whether its devices tell when a switch is let go.
bool TellsRelease(const SwitchConfig& config);

/// The one or two devices. `config` as ValidateSwitch takes it.
std::vector<EventDeviceConfig> EventDevices(const SwitchConfig& config);

}  // namespace beckon::ui_bridge
