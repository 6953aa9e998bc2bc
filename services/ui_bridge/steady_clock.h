// A clock for pacing: setting the machine's time does not move it.
#pragma once

#include <chrono>

#include "services/base/utime.h"

namespace beckon::ui_bridge {

/// Microseconds since some fixed moment; never goes back.
class SteadyClock final : public Clock {
 public:
  Utime Now() const override {
    const auto since = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::microseconds>(since).count();
  }
};

}  // namespace beckon::ui_bridge
