// Publishes BECKON_STATUS once a second for a service.
#pragma once

#include <functional>
#include <string>

#include "lcmtypes/messages.h"
#include "services/base/bus.h"
#include "services/base/run_loop.h"

namespace beckon {

/// This machine's name; "unnamed" where it has none.
std::string HostName();

/// While it lives, publishes what `fill` adds (state line, counters) to name, host, pid, build,
/// messages received and refused, resident memory.
class StatusReporter {
 public:
  StatusReporter(std::string service, Bus& bus, RunLoop& loop,
                 std::function<void(msg::Status&)> fill);
  ~StatusReporter();

 private:
  RunLoop& loop_;
  RunLoop::TimerId timer_;
};

}  // namespace beckon
