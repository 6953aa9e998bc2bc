// Leases on the bus: what the service needs to share users with those of other machines.
#pragma once

#include <functional>
#include <string>

#include "services/base/bus.h"
#include "services/base/run_loop.h"
#include "services/base/utime.h"
#include "services/intention/core/led_conversation.h"

namespace beckon::intention {

/// Who holds leases in this run of the service on `machine`.
LeaseHolder NewHolder(const std::string& machine);

/// Feeds the conversation with LEASE, TASK and signs of life of other intention services, and ticks
/// it. `publish` sends what it answers. All must outlive this.
class LeadService {
 public:
  LeadService(LedConversation& conversation, Bus& bus, RunLoop& loop, const Clock& clock,
              std::function<void(const Actions&)> publish);
  ~LeadService();
  LeadService(const LeadService&) = delete;
  LeadService& operator=(const LeadService&) = delete;

  /// Counters for the status.
  void Fill(msg::Status& status) const;

 private:
  const LedConversation& conversation_;
  RunLoop& loop_;
  RunLoop::TimerId tick_;
};

}  // namespace beckon::intention
