// STATUS: that a process lives and how it fares.
#include <beckon/status_t.hpp>

#include "lcmtypes/codec.h"
#include "lcmtypes/codec/message.h"
#include "lcmtypes/codec/parts.h"

namespace beckon {
namespace codec {

constexpr int kMaxHost = 256;

static void Walk(Walker& w, const status_t*) {
  w.Skip(8);
  w.String("service", kMaxName);
  w.String("host", kMaxHost);
  w.Skip(4 + 8);
  w.String("build", kMaxText);
  w.String("state", kMaxText);
  const int32_t counters = w.Count("n_counters", msg::kMaxCounters);
  for (int32_t i = 0; i < counters && w.ok(); ++i) {
    w.String("counter", kMaxName);
    w.Skip(8);
  }
}

static Status Check(const msg::Status& status) {
  Rules rules("status");
  rules.Time(status.utime)
      .Name(status.service, "service")
      .Text(status.host, "host", kMaxHost)
      .Text(status.build, "build")
      .Text(status.state, "state")
      .Count(status.counters.size(), "counters", msg::kMaxCounters);
  for (const auto& counter : status.counters) rules.Name(counter.name, "counter");
  return rules;
}

static status_t ToWire(const msg::Status& status) {
  status_t wire{};
  wire.utime = status.utime;
  wire.service = status.service;
  wire.host = status.host;
  wire.pid = status.pid;
  wire.started_utime = status.started_utime;
  wire.build = status.build;
  wire.state = status.state;
  wire.n_counters = static_cast<int32_t>(status.counters.size());
  for (const auto& counter : status.counters) {
    counter_t c{};
    c.name = counter.name;
    c.value = counter.value;
    wire.counters.push_back(c);
  }
  return wire;
}

static Result<msg::Status> FromWire(const status_t& wire) {
  msg::Status status;
  status.utime = wire.utime;
  status.service = wire.service;
  status.host = wire.host;
  status.pid = wire.pid;
  status.started_utime = wire.started_utime;
  status.build = wire.build;
  status.state = wire.state;
  for (const auto& c : wire.counters) status.counters.push_back({c.name, c.value});
  return status;
}

}  // namespace codec

BECKON_DEFINE_CODEC(Status, status_t)

}  // namespace beckon
