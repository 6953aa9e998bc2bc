// A bus that nobody else is on: a network namespace of this process's own, or where the system
// forbids one, a port of its own that does not leave the machine.
#pragma once

#include <string>

#include "services/base/result.h"

namespace beckon::tool {

struct PrivateBus {
  std::string lcm_url;  // for this process and its children
  bool isolated = false;
  std::string note;  // for people: why it is not isolated; empty otherwise
};

/// Moves the calling process (and what it starts from then on) into a network of its own, whose
/// only interface is a loopback that carries multicast. Call early: it must have one thread only.
/// Where that is not allowed, the bus is a port of its own with ttl=0 and `note` says so.
PrivateBus EnterPrivateBus();

/// The loopback of the network this process is in: up, multicast, and a route for 224.0.0.0/4 to
/// it. Needs CAP_NET_ADMIN there.
Status PrepareLoopback();

}  // namespace beckon::tool
