// LEASE: who leads the conversation with a user.
#include <beckon/lease_t.hpp>

#include "lcmtypes/codec.h"
#include "lcmtypes/codec/message.h"
#include "lcmtypes/codec/parts.h"

namespace beckon {
namespace codec {

constexpr int kLongestLease_ms = 60'000;

static void Walk(Walker& w, const lease_t*) {
  w.Skip(8);
  w.String("user", kMaxName);
  w.String("session_id", kMaxName);
  w.String("holder", kMaxName);
  w.String("run", kMaxName);
  w.Skip(8 + 4);
  Walk(w, static_cast<const seal_t*>(nullptr));
}

static Status Check(const msg::Lease& lease) {
  return Rules("lease")
      .Time(lease.utime)
      .Name(lease.user, "user")
      .Require(IsUserName(lease.user), "user: expected letters, digits, '_', '.' or '-'")
      .Name(lease.session_id, "session_id")
      .Name(lease.holder, "holder")
      .Name(lease.run, "run")
      .Require(lease.term >= 1, "term is below 1")
      .Range(lease.remaining_ms, "remaining_ms", 0, kLongestLease_ms)
      .Require(Check(lease.seal));
}

static lease_t ToWire(const msg::Lease& lease) {
  lease_t wire{};
  wire.utime = lease.utime;
  wire.user = lease.user;
  wire.session_id = lease.session_id;
  wire.holder = lease.holder;
  wire.run = lease.run;
  wire.term = lease.term;
  wire.remaining_ms = lease.remaining_ms;
  wire.seal = ToWire(lease.seal);
  return wire;
}

static Result<msg::Lease> FromWire(const lease_t& wire) {
  return msg::Lease{wire.utime, wire.user, wire.session_id,   wire.holder,
                    wire.run,   wire.term, wire.remaining_ms, FromWire(wire.seal)};
}

}  // namespace codec

BECKON_DEFINE_CODEC(Lease, lease_t)

}  // namespace beckon
