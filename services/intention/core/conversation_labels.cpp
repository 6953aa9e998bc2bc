// What the user said the objects are, on its way to perception: told at once, taken back with the
// answer, repeated until a scene shows it.
#include <algorithm>

#include "services/intention/core/conversation.h"
#include "services/intention/core/conversation_talk.h"

namespace beckon::intention {
namespace {

/// Whether perception took it. Nothing shows that it heard of a label taken back.
bool IsShown(const msg::Label& label, const msg::Scene& scene) {
  if (label.state != msg::LabelState::kGiven || scene.source != label.source) return false;
  const auto object = std::ranges::find(scene.objects, label.object_id, &msg::SceneObject::id);
  return object != scene.objects.end() && !object->ask_user && object->category == label.category;
}

}  // namespace

void Conversation::PointAt(const Talk& talk, int object, msg::Label& label) const {
  int id = talk.table->IdNow(object);
  // What is taken back is known by its label alone.
  if (label.state == msg::LabelState::kRetracted)
    id = talk.table->objects()[static_cast<size_t>(object)].object.id;
  if (id == 0) return;
  label.object_id = id;
  label.source = talk.table->source();
  label.scene_seq = talk.table->seq();
  label.scene_utime = talk.table->utime();
}

void Conversation::SendLabel(const Talk& talk, const LabelRecord& said, int object,
                             msg::LabelState state, Utime now) {
  PendingLabel& pending = labels_[said.id];
  msg::Label label;
  // Later than what was said of it before, however fast the user is.
  label.utime = std::max(now, pending.label.utime + 1);
  label.label_id = said.id;
  label.session_id = said.session_id;
  label.user = said.user;
  label.state = state;
  label.category = said.category;
  PointAt(talk, object, label);
  pending = {label, 0, state == msg::LabelState::kRetracted ? now + config_.retract_lifetime : 0};
  ++counters_.labels;
}

void Conversation::TellLabels(Talk& talk, Utime now) {
  std::map<int, LabelRecord> given;
  const auto said = talk.interview->Labels();
  const auto records = LabelsOf(talk, now);
  for (size_t i = 0; i < said.size(); ++i) given.emplace(said[i].object, records[i]);
  for (const auto& [object, record] : talk.told) {
    if (!given.contains(object)) SendLabel(talk, record, object, msg::LabelState::kRetracted, now);
  }
  for (const auto& [object, record] : given) {
    const auto before = talk.told.find(object);
    if (before == talk.told.end() || before->second.category != record.category)
      SendLabel(talk, record, object, msg::LabelState::kGiven, now);
  }
  talk.told = std::move(given);
  RepeatLabels(now);
}

void Conversation::RetractLabels(Talk& talk, Utime now) {
  for (const auto& [object, record] : talk.told)
    SendLabel(talk, record, object, msg::LabelState::kRetracted, now);
  talk.told.clear();
  RepeatLabels(now);
}

void Conversation::EndLabels(const Talk& talk, Utime now) {
  for (const auto& [object, record] : talk.told) {
    const auto pending = labels_.find(record.id);
    if (pending != labels_.end()) pending->second.until = now + config_.label_lifetime;
  }
}

void Conversation::RepeatLabels(Utime now) {
  for (auto& [user, talk] : talks_) {  // perception may have begun anew, with other ids
    for (const auto& [object, record] : talk->told) {
      if (const auto own = labels_.find(record.id); own != labels_.end())
        PointAt(*talk, object, own->second.label);
    }
  }
  std::erase_if(labels_, [&](const auto& entry) {
    const PendingLabel& pending = entry.second;
    return (pending.until != 0 && pending.until <= now) ||
           (pending.sent != 0 && scene_ && IsShown(pending.label, *scene_));
  });
  for (auto& [id, pending] : labels_) {
    if (pending.label.object_id == 0) continue;  // not in sight yet
    if (pending.sent != 0 && now - pending.sent < config_.label_period) continue;
    pending.sent = now;
    actions_.push_back(pending.label);
  }
}

}  // namespace beckon::intention
