// What front ends are told of a user's past.
#include <algorithm>
#include <utility>

#include "services/intention/core/conversation.h"
#include "services/intention/core/conversation_talk.h"

namespace beckon::intention {

void Conversation::TellProfile(const std::string& user, Utime now) {
  const auto users = memory_.Users();
  const auto sessions = memory_.SessionsOf(user);
  if (!users || !sessions)
    return Refuse("BECKON_SESSION", refusal::kStorage,
                  (users ? sessions.error() : users.error()).message);
  msg::Profile profile;
  profile.utime = now;
  profile.user = user;
  const size_t n_users = std::min<size_t>(users->size(), msg::kMaxUsers);
  profile.users.assign(users->begin(), users->begin() + static_cast<std::ptrdiff_t>(n_users));
  profile.n_sessions = static_cast<int>(sessions->size());
  const size_t n_recent = std::min<size_t>(sessions->size(), msg::kMaxPastSessions);
  for (size_t i = sessions->size() - n_recent; i < sessions->size(); ++i) {
    const SessionRecord& past = (*sessions)[i];
    profile.recent.push_back(
        {past.utime, past.action, past.category, past.instance, past.questions, past.device});
  }
  actions_.push_back(std::move(profile));
}

/// After a task was told, not before: reading takes milliseconds.
void Conversation::TellProfiles(Utime now) {
  for (auto& [user, due] : profiled_) {
    if (std::exchange(due, false)) TellProfile(user, now);
  }
}

}  // namespace beckon::intention
