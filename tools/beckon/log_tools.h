// `beckon record` and `beckon replay`: LCM's own logger and player, with URLs that lose nothing.
#pragma once

#include <string>

#include "services/base/result.h"

namespace beckon::tool {

/// Becomes lcm-logger, writing everything on `lcm_url` to `log`, which must not exist. Returns on
/// failure only.
Status Record(const std::string& log, const std::string& lcm_url);

/// Becomes lcm-logplayer, publishing `log` on `lcm_url` at `speed` times its pace. Returns on
/// failure only.
Status Replay(const std::string& log, const std::string& lcm_url, double speed);

}  // namespace beckon::tool
