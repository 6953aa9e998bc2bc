// Runs an event loop until something is so.
#pragma once

#include <functional>

#include "services/base/run_loop.h"

namespace beckon::faults {

/// False after `timeout_s`. Looks every `look_us`.
inline bool RunUntil(RunLoop& loop, const std::function<bool()>& condition, double timeout_s,
                     Utime look_us = 2'000) {
  if (condition()) return true;
  bool met = false;
  const auto look = loop.Every(look_us, [&] {
    met = condition();
    if (met) loop.Stop();
  });
  const auto deadline =
      loop.After(static_cast<Utime>(timeout_s * kSecond), [&loop] { loop.Stop(); });
  loop.Run();
  loop.Cancel(look);
  loop.Cancel(deadline);
  return met;
}

}  // namespace beckon::faults
