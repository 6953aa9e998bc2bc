// PROFILE: whom intention knows, and one user's past.
#include <algorithm>
#include <beckon/profile_t.hpp>

#include "lcmtypes/codec.h"
#include "lcmtypes/codec/message.h"
#include "lcmtypes/codec/parts.h"

namespace beckon {
namespace codec {

static void Walk(Walker& w, const past_session_t*) {
  w.Skip(8);
  w.String("action", kMaxName);
  w.String("category", kMaxName);
  w.Skip(4 + 4);
  w.String("device", kMaxName);
}

static void Walk(Walker& w, const profile_t*) {
  w.Skip(8);
  w.String("user", kMaxName);
  const int32_t users = w.Count("n_users", msg::kMaxUsers);
  for (int32_t i = 0; i < users && w.ok(); ++i) w.String("user of users", kMaxName);
  w.Skip(4);
  const int32_t recent = w.Count("n_recent", msg::kMaxPastSessions);
  for (int32_t i = 0; i < recent && w.ok(); ++i)
    Walk(w, static_cast<const past_session_t*>(nullptr));
  Walk(w, static_cast<const seal_t*>(nullptr));
}

static Status Check(const msg::PastSession& past) {
  return Rules("past session")
      .Time(past.utime)
      .Name(past.action, "action", kMaxName)
      .Name(past.category, "category", kMaxName)
      .Require(past.instance >= 1, "instance is below 1")
      .Require(past.questions >= 0, "questions is negative")
      .Text(past.device, "device", kMaxName);
}

static Status Check(const msg::Profile& profile) {
  Rules rules("profile");
  rules.Time(profile.utime)
      .Name(profile.user, "user", kMaxName)
      .Require(IsUserName(profile.user), "user: expected letters, digits, '_', '.' or '-'")
      .Count(profile.users.size(), "users", msg::kMaxUsers)
      .Count(profile.recent.size(), "recent", msg::kMaxPastSessions)
      .Require(profile.n_sessions >= static_cast<int>(profile.recent.size()),
               "n_sessions is less than the sessions named")
      .Require(Check(profile.seal));
  for (const auto& user : profile.users) {
    rules.Name(user, "users", kMaxName)
        .Require(IsUserName(user), "users: expected letters, digits, '_', '.' or '-'");
  }
  for (const auto& past : profile.recent) rules.Require(Check(past));
  return rules;
}

static profile_t ToWire(const msg::Profile& profile) {
  profile_t wire{};
  wire.utime = profile.utime;
  wire.user = profile.user;
  wire.n_users = static_cast<int32_t>(profile.users.size());
  wire.users = profile.users;
  wire.n_sessions = profile.n_sessions;
  wire.n_recent = static_cast<int32_t>(profile.recent.size());
  for (const auto& past : profile.recent) {
    past_session_t p{};
    p.utime = past.utime;
    p.action = past.action;
    p.category = past.category;
    p.instance = past.instance;
    p.questions = past.questions;
    p.device = past.device;
    wire.recent.push_back(p);
  }
  wire.seal = ToWire(profile.seal);
  return wire;
}

static Result<msg::Profile> FromWire(const profile_t& wire) {
  msg::Profile profile;
  profile.utime = wire.utime;
  profile.user = wire.user;
  profile.users = wire.users;
  profile.n_sessions = wire.n_sessions;
  for (const auto& p : wire.recent)
    profile.recent.push_back({p.utime, p.action, p.category, p.instance, p.questions, p.device});
  profile.seal = FromWire(wire.seal);
  return profile;
}

}  // namespace codec

BECKON_DEFINE_CODEC(Profile, profile_t)

}  // namespace beckon
