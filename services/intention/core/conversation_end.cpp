// How sessions end: confirmed, abandoned, stopped; and what is repeated until somebody hears it.
#include "services/intention/core/conversation.h"
#include "services/intention/core/conversation_talk.h"

namespace beckon::intention {
namespace {

constexpr char kSessionChannel[] = "BECKON_SESSION";
constexpr char kTaskStatusChannel[] = "BECKON_TASK_STATUS";
constexpr size_t kRememberedEnds = 32;

}  // namespace

std::vector<LabelRecord> Conversation::LabelsOf(const Talk& talk, Utime now) const {
  std::vector<LabelRecord> records;
  for (const GivenLabel& label : talk.interview->Labels()) {
    const msg::SceneObject& object = talk.table->objects()[label.object].object;
    LabelRecord record;
    record.id = talk.session_id + "/label/" + std::to_string(label.object);
    record.session_id = talk.session_id;
    record.user = talk.user;
    record.utime = now;
    record.category = label.category;
    record.source = talk.table->source();
    record.centroid_W = object.centroid_W;
    record.extent_W = object.extent_W;
    record.probabilities = object.probabilities;
    records.push_back(std::move(record));
  }
  return records;
}

msg::Task Conversation::MakeTask(const Talk& talk, const AcceptedTask& accepted, Utime now) const {
  const Followed& followed = talk.table->objects()[accepted.object];
  const msg::SceneObject& object = followed.object;
  msg::Task task;
  task.utime = now;
  task.task_id = talk.session_id;
  task.user = talk.user;
  task.action = accepted.action;
  task.object = {object.id, accepted.category, accepted.instance};
  task.centroid_W = followed.seen_W.value_or(object.centroid_W);
  if (const auto pose = talk.poses.find(accepted.object);
      pose != talk.poses.end() && IsNear(pose->second, followed)) {
    task.has_pose = true;
    task.pose = pose->second;
  }
  task.pose.object_id = object.id;
  task.X_WC = talk.table->X_WC();
  task.posterior = std::min(accepted.posterior, 1.0);
  task.questions = talk.interview->questions();
  task.expires_utime = now + config_.task_lifetime;
  return task;
}

/// On disk first, then the task; neither where its object is not seen at its place, or where
/// another may have begun to speak for the user.
void Conversation::Confirm(Talk& talk, const AcceptedTask& accepted, Utime now) {
  if (HoldBack(talk, accepted, now) || !may_act_(talk.user)) return;
  SessionRecord record;
  record.session_id = talk.session_id;
  record.user = talk.user;
  record.device = talk.device;
  record.utime = now;
  record.category = accepted.category;
  record.action = accepted.action;
  record.instance = accepted.instance;
  record.questions = talk.interview->questions();
  record.posterior = accepted.posterior;
  record.present = talk.interview->Present();
  record.answers = talk.interview->Answers();
  const msg::Task task = MakeTask(talk, accepted, now);
  EndLabels(talk, now);
  const auto committed = memory_.Commit(record, LabelsOf(talk, now), task);
  if (!committed) {
    return Abandon(talk,
                   Finished(Fill(config_.phrases, config_.phrases.not_remembered, "reason",
                                 committed.error().message)),
                   now, false);
  }
  // The disk may have taken its time: then it comes here again, or is withdrawn.
  const bool may_tell = may_act_(talk.user);
  if (*committed) {
    ++counters_.confirmed;
    SceneFollower table = may_tell ? *std::move(talk.table) : *talk.table;
    tasks_.insert_or_assign(task.task_id,
                            PendingTask{task, 0, std::move(table), accepted.object, {}, false});
  }
  if (!may_tell) return;
  if (const auto own = tasks_.find(task.task_id);
      own != tasks_.end() && !own->second.told && !own->second.revoked)
    TellTask(own->second, now);
  msg::Session event = Event(msg::SessionKind::kConfirmed, now);
  event.session_id = record.session_id;
  event.user = record.user;
  event.questions = record.questions;
  event.text = DoneText(accepted.text);
  Announce(event, now);
  if (const auto asked = profiled_.find(record.user); asked != profiled_.end())
    asked->second = true;
  End(talk.user);
}

std::string Conversation::DoneText(const std::string& task) const {
  return Finished(Fill(config_.phrases, config_.phrases.done, "task", task));
}

std::string Conversation::DoneText(const msg::Task& task) const {
  return DoneText(TaskText(affordances_, task.action, task.object.category, config_.phrases));
}

void Conversation::Abandon(Talk& talk, const std::string& text, Utime now, bool keep_labels) {
  ++counters_.abandoned;
  if (keep_labels && talk.interview) {
    if (Status kept = memory_.CommitLabels(LabelsOf(talk, now)); !kept) {
      Refuse(kSessionChannel, refusal::kStorage, kept.error().message);
    }
  }
  keep_labels ? EndLabels(talk, now) : RetractLabels(talk, now);
  msg::Session event = Event(msg::SessionKind::kAbandoned, now);
  event.session_id = talk.session_id;
  event.user = talk.user;
  event.questions = talk.interview ? talk.interview->questions() : 0;
  event.text = text;
  Announce(event, now);
  End(talk.user);
}

void Conversation::End(std::string user) {
  Remember(latest_);
  talks_.erase(user);
}

void Conversation::Remember(const msg::Session& end) {
  ended_.push_back(end);
  if (ended_.size() > kRememberedEnds) ended_.pop_front();
}

void Conversation::Stop(const msg::Session& request, Utime now) {
  if (stopped_) return Announce(msg::Session(latest_), now);
  if (Seen(request)) return;  // a late duplicate, after "resume"
  stopped_ = true;
  msg::Session event = Event(msg::SessionKind::kStopped, now);
  event.session_id = request.session_id;
  event.user = request.user;
  event.text = Finished(config_.phrases.stopped);
  Announce(event, now);
  for (Talk* talk : Talks()) RetractLabels(*talk, now);
  talks_.clear();
  if (Status set = memory_.SetStopped(true, now); !set)
    Refuse(kSessionChannel, refusal::kStorage, set.error().message);
  RevokeTasks(now);
}

void Conversation::RevokeTasks(Utime now) {
  for (auto& [id, pending] : tasks_) {
    if (!pending.revoked) RevokeTask(pending, Finished(config_.phrases.revoked), now);
  }
  tasks_.clear();
}

void Conversation::Resume(const msg::Session& request, Utime now) {
  // Also remembered while nothing is stopped: a late duplicate must not undo a later stop.
  if (Seen(request) || !stopped_) return;
  if (Status set = memory_.SetStopped(false, now); !set)
    return Refuse(kSessionChannel, refusal::kStorage, set.error().message);
  stopped_ = false;
  Announce(Event(msg::SessionKind::kIdle, now), now);
}

Actions Conversation::OnTaskStatus(const msg::TaskStatus& status, Utime now) {
  const auto pending = tasks_.find(status.task_id);
  if (pending == tasks_.end()) return Taken();
  // A robot that took it all the same may not have heard yet; our own word comes back to us too.
  const bool over =
      status.state == msg::TaskState::kDone || status.state == msg::TaskState::kFailed;
  if (pending->second.revoked && !over) return Taken();
  if (Status noted = memory_.NoteTask(status.task_id, status.state, now); !noted) {
    Refuse(kTaskStatusChannel, refusal::kStorage, noted.error().message);
  }
  tasks_.erase(pending);
  return Taken();
}

void Conversation::TellTask(PendingTask& pending, Utime now) {
  counters_.tasks += pending.told ? 0 : 1;
  pending.told = true;
  pending.sent = now;
  actions_.push_back(pending.task);
}

void Conversation::RepeatTasks(Utime now) {
  for (auto entry = tasks_.begin(); entry != tasks_.end();) {
    auto& [id, pending] = *entry;
    if (pending.task.expires_utime <= now && pending.revoked) {
      entry = tasks_.erase(entry);
      continue;
    }
    if (pending.task.expires_utime <= now) {
      ++counters_.expired;
      actions_.push_back(msg::TaskStatus{
          now, id, msg::TaskState::kExpired, Finished(config_.phrases.no_robot), {}});
      if (Status noted = memory_.NoteTask(id, msg::TaskState::kExpired, now); !noted) {
        Refuse(kTaskStatusChannel, refusal::kStorage, noted.error().message);
      }
      entry = tasks_.erase(entry);
      continue;
    }
    const bool in_doubt = (IsFresh(pending.table, now) && !IsInView(pending)) || !pending.told;
    if (now - pending.sent >= config_.task_period && (pending.revoked || !in_doubt)) {
      pending.sent = now;
      if (pending.revoked) {
        pending.revoked->utime = now;
        actions_.push_back(*pending.revoked);
      } else {
        TellTask(pending, now);
      }
    }
    ++entry;
  }
}

Actions Conversation::Tick(Utime now) {
  for (auto& [user, talk] : talks_) {
    if (talk->query && now - talk->query_sent >= config_.query_period) {
      talk->query_sent = now;
      actions_.push_back(*talk->query);
    }
    if (now - talk->announced >= config_.announce_period) AnnounceRunning(*talk, now);
  }
  // A scene that was fresh may have grown old, and poses are waited for only so long.
  for (Talk* talk : Talks()) Recheck(*talk, now);
  BeginWaiting(now);
  TellProfiles(now);
  if (now - latest_announced_ >= config_.announce_period && (stopped_ || talks_.empty())) {
    latest_.utime = now;
    Announce(msg::Session(latest_), now);
  }
  RepeatTasks(now);
  RepeatLabels(now);
  return Taken();
}

std::string Conversation::StateText() const {
  if (stopped_) return "stopped";
  if (talks_.empty()) return "idle";
  const Talk& talk = *talks_.begin()->second;
  if (!talk.waits_for.empty()) return talk.waits_for;
  return talk.query ? "asking " + talk.user + ": " + talk.query->text : "busy";
}

}  // namespace beckon::intention
