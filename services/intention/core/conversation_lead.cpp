// What a conversation has to do with other services: sessions taken over from them, left to them,
// and ended by them.
#include <algorithm>

#include "services/intention/core/conversation.h"
#include "services/intention/core/conversation_talk.h"

namespace beckon::intention {

/// From the first question: what was answered elsewhere spoke of another table's objects.
Actions Conversation::TakeOver(const msg::Session& request, Utime now) {
  if (stopped_ || IsOver(request.session_id) || talks_.contains(request.user)) return Taken();
  if (Talk* talk = NewTalk(request)) {
    talk->notice = Finished(config_.phrases.taken_over) + " ";
    TryBegin(*talk, now);
  }
  return Taken();
}

void Conversation::Withdraw(const std::string& user) {
  const auto talk = talks_.find(user);
  if (talk == talks_.end()) return;
  // Its labels stay with perception: they are what the user said.
  for (const auto& [object, record] : talk->second->told) labels_.erase(record.id);
  const auto task = tasks_.find(talk->second->session_id);
  if (task != tasks_.end() && !task->second.told) {
    // On disk, and never to be published: whoever leads asks again.
    if (Status noted =
            memory_.NoteTask(task->first, msg::TaskState::kRevoked, task->second.task.utime);
        !noted)
      Refuse("BECKON_LEASE", refusal::kStorage, noted.error().message);
    tasks_.erase(task);
  }
  talks_.erase(talk);
}

void Conversation::NoteEnd(const msg::Session& event) {
  if (Ended(event.session_id) != nullptr) return;
  Remember(event);
}

std::optional<std::string> Conversation::UserOf(const std::string& session_id) const {
  const auto talk = std::ranges::find_if(
      talks_, [&](const auto& entry) { return entry.second->session_id == session_id; });
  if (talk == talks_.end()) return {};
  return talk->first;
}

bool Conversation::IsOver(const std::string& session_id) const {
  if (Ended(session_id) != nullptr) return true;
  const auto known = memory_.FindSession(session_id);
  return !known || known->has_value();
}

}  // namespace beckon::intention
