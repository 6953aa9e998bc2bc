// Between bytes on the bus and the plain structs of messages.h, with full validation both ways.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/base/result.h"

namespace beckon {

/// kChannel: where the type travels. Encode refuses values that break the type's rules (counts,
/// ranges, non-finite numbers, more than kMaxDatagram for all but frames). Decode refuses bytes
/// that are not exactly one message of the type (fingerprint, lengths, trailing bytes) or whose
/// values break the rules.
template <typename T>
struct Codec;

#define BECKON_DECLARE_CODEC(Type, channel)                             \
  template <>                                                           \
  struct Codec<msg::Type> {                                             \
    static constexpr const char* kChannel = channel;                    \
    static Result<std::vector<uint8_t>> Encode(const msg::Type& value); \
    static Result<msg::Type> Decode(std::span<const uint8_t> bytes);    \
  }

BECKON_DECLARE_CODEC(Frame, "BECKON_FRAME");
BECKON_DECLARE_CODEC(Scene, "BECKON_SCENE");
BECKON_DECLARE_CODEC(Poses, "BECKON_POSES");
BECKON_DECLARE_CODEC(Interface, "BECKON_INTERFACE");
BECKON_DECLARE_CODEC(Query, "BECKON_QUERY");
BECKON_DECLARE_CODEC(Answer, "BECKON_ANSWER");
BECKON_DECLARE_CODEC(Session, "BECKON_SESSION");
BECKON_DECLARE_CODEC(Task, "BECKON_TASK");
BECKON_DECLARE_CODEC(TaskStatus, "BECKON_TASK_STATUS");
BECKON_DECLARE_CODEC(Label, "BECKON_LABEL");
BECKON_DECLARE_CODEC(Profile, "BECKON_PROFILE");
BECKON_DECLARE_CODEC(Highlight, "BECKON_HIGHLIGHT");
BECKON_DECLARE_CODEC(Stimulus, "BECKON_STIMULUS");
BECKON_DECLARE_CODEC(Decoding, "BECKON_DECODING");
BECKON_DECLARE_CODEC(History, "BECKON_HISTORY");
BECKON_DECLARE_CODEC(Lease, "BECKON_LEASE");
BECKON_DECLARE_CODEC(Status, "BECKON_STATUS");

#undef BECKON_DECLARE_CODEC

}  // namespace beckon
