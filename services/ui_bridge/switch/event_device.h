// A switch on an evdev device, or on a FIFO that carries the same stream. It may come late, be
// unplugged and come back.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "services/base/run_loop.h"
#include "services/ui_bridge/switch/key_map.h"
#include "services/ui_bridge/switch/switch_source.h"

namespace beckon::ui_bridge {

struct EventDeviceConfig {
  /// A path (/dev/input/by-id/..., a FIFO), "name:TEXT" for the first device of that name, or
  /// "uniq:TEXT" for the one of that identity (EVIOCGNAME, EVIOCGUNIQ).
  std::string device;
  KeyChoice main;
  KeyChoice select;
  bool grab = false;               // EVIOCGRAB: nobody else gets its keys
  Utime first_retry_us = 250'000;  // doubles up to the last
  Utime last_retry_us = 4 * kSecond;
};

/// Tells the user once when it goes, or is not there at first, and once when it comes.
std::unique_ptr<SwitchSource> MakeEventDevice(const EventDeviceConfig& config, RunLoop& loop,
                                              SwitchListener& listener);

}  // namespace beckon::ui_bridge
