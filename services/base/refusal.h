// Why messages are refused: the short keys by which Bus::Refuse counts, STATUS tells, and `beckon
// top` shows. A new reason is named here and in docs/protocol.md.
#pragma once

namespace beckon::refusal {

inline constexpr char kMalformed[] =
    "malformed";                               // not one message of its type, or against its rules
inline constexpr char kDamaged[] = "damaged";  // well formed around content that cannot be used
inline constexpr char kHandler[] = "handler";  // the service failed on it
inline constexpr char kStale[] = "stale";      // about what is over, or superseded
inline constexpr char kDuplicate[] = "duplicate";  // heard before, where that is no repetition
inline constexpr char kForeign[] = "foreign";      // for, or by, somebody else
inline constexpr char kUnknown[] = "unknown";      // names what is not known here
inline constexpr char kTooMany[] = "too_many";     // one more than is served at a time
inline constexpr char kStorage[] = "storage";      // it could not be stored, or looked up

// Where messages are signed:
inline constexpr char kUnsigned[] = "unsigned";
inline constexpr char kUnknownKey[] = "unknown_key";  // not trusted here
inline constexpr char kRevoked[] = "revoked";         // its key was
inline constexpr char kNotAllowed[] = "not_allowed";  // its key has another role
inline constexpr char kExpired[] = "expired";         // too old, or the clocks differ
inline constexpr char kForged[] = "forged";           // its signature is none: made up, or altered
inline constexpr char kReplayed[] = "replayed";       // heard before, or overtaken by very many
inline constexpr char kTooManySenders[] = "too_many_senders";  // of one key

}  // namespace beckon::refusal
