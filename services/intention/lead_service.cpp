#include "services/intention/lead_service.h"

#include <unistd.h>

#include <cstdio>
#include <random>
#include <utility>

#include "services/base/status_reporter.h"

namespace beckon::intention {
namespace {

/// Also of what the conversation repeats.
constexpr Utime kTickPeriod = kSecond / 20;

}  // namespace

LeaseHolder NewHolder(const std::string& machine) {
  std::random_device random;
  char run[17];
  std::snprintf(run, sizeof run, "%08x%08x", random(), random());
  return {machine, run};
}

LeadService::LeadService(LedConversation& conversation, Bus& bus, RunLoop& loop, const Clock& clock,
                         std::function<void(const Actions&)> publish)
    : conversation_(conversation), loop_(loop) {
  bus.Subscribe<msg::Lease>([&conversation, &clock, publish](const msg::Lease& lease) {
    publish(conversation.OnLease(lease, clock.Now()));
  });
  bus.Subscribe<msg::Task>([&conversation, &clock, publish](const msg::Task& task) {
    publish(conversation.OnTask(task, clock.Now()));
  });
  // The only thing that a service says when it has nothing to say. One process is one machine's.
  bus.Subscribe<msg::Status>([&conversation, pid = getpid()](const msg::Status& status) {
    if (status.service != "intention") return;
    const bool own = status.pid == pid && status.host == HostName();
    if (!own) conversation.HearPeer();
  });
  tick_ = loop.Every(kTickPeriod, [&conversation, &clock, publish = std::move(publish)] {
    publish(conversation.Tick(clock.Now()));
  });
}

LeadService::~LeadService() { loop_.Cancel(tick_); }

void LeadService::Fill(msg::Status& status) const {
  const LeadCounters& counters = conversation_.counters();
  status.counters.push_back({"lease_term", conversation_.leases().term()});
  status.counters.push_back(
      {"leases_held", static_cast<int64_t>(conversation_.leases().Held().size())});
  status.counters.push_back({"taken_over", counters.taken_over});
  status.counters.push_back({"yielded", counters.yielded});
}

}  // namespace beckon::intention
