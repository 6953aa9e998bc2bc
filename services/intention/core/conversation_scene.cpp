// How the conversation follows the table: what sessions take over of a new scene, and whether an
// object is where it was when a task for it is confirmed, or waits for its robot.
#include <algorithm>

#include "services/intention/core/conversation.h"
#include "services/intention/core/conversation_talk.h"

namespace beckon::intention {
namespace {

constexpr char kSessionChannel[] = "BECKON_SESSION";

}  // namespace

std::vector<Conversation::Talk*> Conversation::Talks() {
  std::vector<Talk*> talks;
  for (auto& [user, talk] : talks_) talks.push_back(talk.get());
  return talks;
}

bool Conversation::IsFresh(const SceneFollower& table, Utime now) const {
  return now - table.seen() <= config_.scene_max_age;
}

/// A copy that came late, after newer ones; a perception or a log that began anew is none.
bool Conversation::IsLate(const msg::Scene& scene, Utime now) const {
  return scene_ && scene.source == scene_->source && scene.seq < scene_->seq &&
         scene.utime < scene_->utime && now - scene_arrived_ <= config_.scene_max_age;
}

Actions Conversation::OnScene(const msg::Scene& scene, Utime now) {
  if (IsLate(scene, now)) {
    ++counters_.late_scenes;
    return Taken();
  }
  scene_ = scene;
  scene_arrived_ = now;
  WatchTasks(now);
  FollowScene(now);
  BeginWaiting(now);
  return Taken();
}

void Conversation::FollowScene(Utime now) {
  for (Talk* talk : Talks()) {
    if (!talk->table) continue;
    const bool changed = talk->table->See(*scene_, now);
    MatchPoses(*talk);
    if (!talk->interview) continue;
    changed ? Follow(*talk, now) : Recheck(*talk, now);
  }
}

std::vector<TableObject> Conversation::TableOf(Talk& talk) {
  const auto& objects = talk.table->objects();
  if (talk.remembered.size() < objects.size()) {
    const auto labels = memory_.LabelsOf(talk.table->source());
    if (!labels) Refuse(kSessionChannel, refusal::kStorage, labels.error().message);
    for (size_t i = talk.remembered.size(); i < objects.size(); ++i) {
      CheckCategory(objects[i].object);
      const LabelRecord* label =
          labels ? FindLabel(*labels, talk.table->source(), objects[i].object, config_.labels)
                 : nullptr;
      talk.remembered.push_back(label == nullptr ? "" : label->category);
    }
  }
  std::vector<TableObject> table;
  for (size_t i = 0; i < objects.size(); ++i)
    table.push_back({objects[i].object, talk.remembered[i], objects[i].gone});
  return table;
}

void Conversation::Follow(Talk& talk, Utime now) {
  const std::vector<TableObject> table = TableOf(talk);
  talk.notice += WhatBecameOfIt(talk, table);
  talk.interview->Look(table);
  Advance(talk, now);
}

/// Where what the user was asked about, or said yes to, is there no longer: a sentence.
std::string Conversation::WhatBecameOfIt(const Talk& talk,
                                         const std::vector<TableObject>& table) const {
  const auto* accepted = std::get_if<AcceptedTask>(&talk.interview->outcome());
  const int object = accepted != nullptr ? accepted->object : talk.interview->asked_object();
  if (object < 0) return {};
  const TableObject& now = table[static_cast<size_t>(object)];
  const bool moved = accepted != nullptr && talk.interview->HasMoved(now, object);
  if (!now.gone && !moved) return {};
  const Phrases& phrases = config_.phrases;
  return talk.interview->Say(now.gone ? phrases.object_gone : phrases.object_moved, object) + " ";
}

void Conversation::Recheck(Talk& talk, Utime now) {
  if (talk.interview && std::holds_alternative<AcceptedTask>(talk.interview->outcome()))
    Advance(talk, now);
}

/// True: the task is not to be done now. Its object is looked for as long as there are scenes; then
/// the user is asked again.
bool Conversation::HoldBack(Talk& talk, const AcceptedTask& accepted, Utime now) {
  if (talk.table->Shows(accepted.object)) return false;
  const bool holds = !talk.query;
  if (IsFresh(*talk.table, now)) {
    counters_.held += holds ? 0 : 1;
    talk.query.reset();
    WaitFor(talk, talk.interview->Say(config_.phrases.looking_for, accepted.object), now);
    return true;
  }
  if (!holds) return false;  // nobody looks at the table: it was there when somebody last did
  talk.notice = talk.interview->Say(config_.phrases.out_of_sight, accepted.object) + " ";
  talk.interview->Doubt(accepted.object);
  Advance(talk, now);
  return true;
}

/// Tasks that no robot took yet.
void Conversation::WatchTasks(Utime now) {
  for (auto& [id, pending] : tasks_) {
    pending.table.See(*scene_, now);
    if (pending.revoked) continue;
    const Followed& object = pending.table.objects()[static_cast<size_t>(pending.object)];
    const bool moved = pending.table.Shows(pending.object) && !IsInView(pending);
    if (!object.gone && !moved) continue;
    const int category = affordances_.FindCategory(pending.task.object.category);
    const Situation alone = MakeSituation(affordances_, {{category, 0, 0}});
    const std::string& sentence =
        object.gone ? config_.phrases.object_gone : config_.phrases.object_moved;
    RevokeTask(pending, ObjectText(affordances_, alone, 0, sentence, config_.phrases), now);
  }
}

void Conversation::RevokeTask(PendingTask& pending, const std::string& text, Utime now) {
  ++counters_.revoked;
  pending.revoked = msg::TaskStatus{now, pending.task.task_id, msg::TaskState::kRevoked, text, {}};
  pending.sent = now;
  actions_.push_back(*pending.revoked);
  if (Status noted = memory_.NoteTask(pending.task.task_id, msg::TaskState::kRevoked, now);
      !noted) {
    Refuse(kSessionChannel, refusal::kStorage, noted.error().message);
  }
}

/// Whether the newest scene shows a task's object where the robot was told.
bool Conversation::IsInView(const PendingTask& pending) const {
  const auto& seen_W = pending.table.objects()[static_cast<size_t>(pending.object)].seen_W;
  return seen_W && (*seen_W - pending.task.centroid_W).norm() <= config_.follow.place_m;
}

bool Conversation::IsNear(const msg::ObjectPose& pose, const Followed& object) const {
  const Eigen::Vector3d place_W = object.seen_W.value_or(object.object.centroid_W);
  return (pose.X_WO.translation() - place_W).norm() <= config_.pose_place_m;
}

}  // namespace beckon::intention
