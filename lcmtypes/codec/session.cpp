// SESSION: requests of front ends and events of a conversation.
#include <beckon/session_t.hpp>

#include "lcmtypes/codec.h"
#include "lcmtypes/codec/message.h"
#include "lcmtypes/codec/parts.h"

namespace beckon {
namespace codec {

static bool IsKind(msg::SessionKind kind) {
  const int k = static_cast<int>(kind);
  return (k >= 1 && k <= 7) || (k >= 16 && k <= 20);
}

static void Walk(Walker& w, const session_t*) {
  w.Skip(8);
  w.String("session_id", kMaxName);
  w.String("user", kMaxName);
  w.String("device", kMaxName);
  w.Skip(1 + 4);
  w.String("text", kMaxText);
  Walk(w, static_cast<const seal_t*>(nullptr));
}

static Status Check(const msg::Session& session) {
  const bool idle = session.kind == msg::SessionKind::kIdle;
  const bool start = session.kind == msg::SessionKind::kRequestStart;
  const bool profile = session.kind == msg::SessionKind::kRequestProfile;
  return Rules("session")
      .Time(session.utime)
      .Require(IsKind(session.kind), "kind is unknown")
      .Text(session.session_id, "session_id", kMaxName)
      .Text(session.user, "user", kMaxName)
      .Require(IsUserName(session.user), "user: expected letters, digits, '_', '.' or '-'")
      .Require(!start || (!session.user.empty() && !session.session_id.empty()),
               "a request to start needs user and session_id")
      .Require(!profile || !session.user.empty(), "a request of a profile needs user")
      .Require(!idle || session.session_id.empty(), "idle names no session")
      .Text(session.device, "device", kMaxName)
      .Require(session.questions >= 0, "questions is negative")
      .Text(session.text, "text")
      .Require(Check(session.seal));
}

static session_t ToWire(const msg::Session& session) {
  session_t wire{};
  wire.utime = session.utime;
  wire.session_id = session.session_id;
  wire.user = session.user;
  wire.device = session.device;
  wire.kind = static_cast<int8_t>(session.kind);
  wire.questions = session.questions;
  wire.text = session.text;
  wire.seal = ToWire(session.seal);
  return wire;
}

static Result<msg::Session> FromWire(const session_t& wire) {
  msg::Session session;
  session.utime = wire.utime;
  session.session_id = wire.session_id;
  session.user = wire.user;
  session.device = wire.device;
  session.kind = static_cast<msg::SessionKind>(wire.kind);
  session.questions = wire.questions;
  session.text = wire.text;
  session.seal = FromWire(wire.seal);
  return session;
}

}  // namespace codec

BECKON_DEFINE_CODEC(Session, session_t)

}  // namespace beckon
