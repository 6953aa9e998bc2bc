#include "tools/beckon/top_conversations.h"

#include "tools/beckon/task_words.h"

namespace beckon::tool {
namespace {

/// A hostile bus must not fill the memory.
constexpr size_t kMostUsers = 64;

}  // namespace

TopConversations::Talk* TopConversations::Find(const std::string& user) {
  if (user.empty() || (talks_.size() >= kMostUsers && !talks_.contains(user))) return nullptr;
  Talk& talk = talks_[user];
  talk.view.user = user;
  return &talk;
}

void TopConversations::Tell(Talk& talk, const std::string& state, const std::string& text,
                            Utime now) {
  if (talk.view.state == state && talk.view.text == text) return;
  talk.view.state = state;
  talk.view.text = text;
  talk.view.kind.clear();
  talk.query_id = 0;
  talk.since = now;
}

void TopConversations::OnSession(const msg::Session& session, Utime now) {
  using enum msg::SessionKind;
  if (session.kind == kRequestStop || session.kind == kStopped) stopped_ = true;
  if (session.kind == kIdle || session.kind == kBegun || session.kind == kConfirmed)
    stopped_ = false;
  if (stopped_ || session.kind == kIdle) {
    for (auto& [user, talk] : talks_) {
      talk.heard = now;
      if (talk.view.state != "over") Tell(talk, "over", stopped_ ? "stopped" : "", now);
    }
    return;
  }
  if (session.kind != kBegun && session.kind != kConfirmed && session.kind != kAbandoned) return;
  Talk* talk = Find(session.user);
  if (talk == nullptr) return;
  talk->heard = now;
  talk->view.questions = session.questions;
  if (session.kind != kBegun) {
    Tell(*talk, "over", session.text, now);
  } else if (talk->query_id == 0 || talk->session_id != session.session_id ||
             !session.text.empty()) {
    Tell(*talk, "waiting", session.text, now);
  }
  talk->session_id = session.session_id;
}

void TopConversations::OnQuery(const msg::Query& query, Utime now) {
  Talk* talk = Find(query.user);
  if (talk == nullptr || stopped_) return;
  talk->heard = now;
  if (talk->query_id == query.id && talk->session_id == query.session_id) return;
  Tell(*talk, "asked", query.text, now);
  talk->session_id = query.session_id;
  talk->query_id = query.id;
  talk->since = now;
  talk->view.kind = Name(query.kind);
  talk->view.questions = query.questions_asked;
}

void TopConversations::OnTask(const msg::Task& task, Utime now) {
  if (task_ && task_->task_id == task.task_id) return;
  task_ = task;
  task_state_ = "published";
  task_since_ = now;
}

void TopConversations::OnTaskStatus(const msg::TaskStatus& status, Utime) {
  if (task_ && task_->task_id == status.task_id) task_state_ = Name(status.state);
}

TopTalks TopConversations::View(Utime now) const {
  TopTalks view;
  view.stopped = stopped_;
  for (const auto& [user, talk] : talks_) {
    view.talks.push_back(talk.view);
    view.talks.back().since_us = now - talk.since;
    view.talks.back().silent = talk.view.state != "over" && now - talk.heard > kSilent_us;
  }
  if (task_)
    view.last_task = TopTask{task_->user, TaskWords(*task_), task_state_, now - task_since_};
  return view;
}

}  // namespace beckon::tool
