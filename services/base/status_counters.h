// The counters that every process's STATUS carries, whatever it does: docs/protocol.md lists them.
#pragma once

#include <cstdint>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/base/bus_traffic.h"

namespace beckon {

/// What the process has taken of the machine.
struct ProcessUsage {
  int64_t cpu_ms = 0;  // of all its threads, since the start
  int64_t rss_kb = 0;  // resident now

  /// Of this process.
  static ProcessUsage Now();
};

/// Remembers what it told last, since rates are from one STATUS to the next.
class StatusCounters {
 public:
  /// `now`: of a clock that only counts up.
  explicit StatusCounters(Utime now, ProcessUsage usage = {})
      : began_(now), last_(now), last_usage_(usage) {}

  std::vector<msg::Counter> Take(const BusTraffic& traffic, ProcessUsage usage, Utime now);

 private:
  struct Sums {
    int64_t received = 0, received_bytes = 0, sent = 0, sent_bytes = 0, refused = 0, lost = 0;
    Utime wait_us = 0, handler_us = 0;
  };
  static Sums SumUp(const BusTraffic& traffic);

  const Utime began_;
  Utime last_;
  ProcessUsage last_usage_;
  Sums last_sums_;
};

}  // namespace beckon
