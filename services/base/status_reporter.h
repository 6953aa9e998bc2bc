// Publishes BECKON_STATUS once a second for a service.
#pragma once

#include <functional>
#include <string>

#include "lcmtypes/messages.h"
#include "services/base/bus.h"
#include "services/base/run_loop.h"
#include "services/base/status_counters.h"

namespace beckon {

/// This machine's name; "unnamed" where it has none.
std::string HostName();

/// While it lives, publishes what `fill` adds (state line, counters of its own) to what every
/// process tells: name, host, pid, build, traffic, times and refusals of its bus, CPU and memory.
class StatusReporter {
 public:
  StatusReporter(std::string service, Bus& bus, RunLoop& loop,
                 std::function<void(msg::Status&)> fill);
  ~StatusReporter();
  StatusReporter(const StatusReporter&) = delete;
  StatusReporter& operator=(const StatusReporter&) = delete;

 private:
  void Report();

  Bus& bus_;
  RunLoop& loop_;
  const std::function<void(msg::Status&)> fill_;
  msg::Status common_;
  StatusCounters counters_;
  RunLoop::TimerId timer_;
};

}  // namespace beckon
