// `beckon record` and `beckon replay`: LCM's own logger and player, with URLs that lose nothing,
// and an index of what is in a log.
#pragma once

#include <optional>
#include <string>

#include "services/base/result.h"

namespace beckon::tool {

/// Runs lcm-logger, writing everything on `lcm_url` to `log`, which must not exist, until Ctrl-C;
/// keeps LOG.index.json beside it, and a STATUS of its own on the bus. 0 then; 1 where the logger
/// ended by itself.
Result<int> Record(const std::string& log, const std::string& lcm_url);

/// What of a log is played. Seconds are from its first message.
struct ReplayPart {
  std::string session;  // number or id; empty: all
  std::optional<double> from_s, to_s;
};

/// Becomes lcm-logplayer, publishing `log`, or a part of it, on `lcm_url` at `speed` times its
/// pace. Returns on failure only.
Status Replay(const std::string& log, const std::string& lcm_url, double speed,
              const ReplayPart& part);

/// Prints what is in a log, and writes LOG.index.json anew where that is possible. Says on standard
/// error what of the log is damaged or cut off.
Status ListLog(const std::string& log);

}  // namespace beckon::tool
