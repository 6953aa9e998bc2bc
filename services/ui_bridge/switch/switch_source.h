// Where a switch's edges come from, and whom they are told.
#pragma once

#include <memory>
#include <string>

#include "services/base/utime.h"
#include "services/ui_bridge/scan/scanner.h"

namespace beckon::ui_bridge {

/// All calls in the loop's thread; `at` is SteadyClock's time.
class SwitchListener {
 public:
  virtual ~SwitchListener() = default;
  virtual void OnEdge(Utime at, scan::Switch which, bool down) = 0;
  /// Of keys that tell no release.
  virtual void OnClick(Utime at, scan::Switch which) = 0;
  /// A key that only stops.
  virtual void OnStopKey() = 0;
  /// What was held is no longer known to be: the device went, or its events were lost.
  virtual void OnRelease(Utime at) = 0;
  /// For the user: the device is there, or is not.
  virtual void OnSourceNotice(const std::string& text) = 0;
};

class SwitchSource {
 public:
  virtual ~SwitchSource() = default;
  /// Begins to listen.
  virtual void Start() = 0;
  /// For BECKON_STATUS: "ok", or what is wrong.
  virtual std::string State() const = 0;
};

}  // namespace beckon::ui_bridge
