// How sessions begin: what an earlier run left, the scene and its poses, what is remembered.
#include <algorithm>

#include "services/intention/core/conversation.h"
#include "services/intention/core/conversation_talk.h"

namespace beckon::intention {
namespace {

constexpr char kSessionChannel[] = "BECKON_SESSION";
constexpr size_t kMostDevices = 64;

/// FNV-1a: the same session has the same ties everywhere.
uint64_t Hash(const std::string& text) {
  uint64_t hash = 14695981039346656037ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  return hash;
}

/// Of an earlier run: its object is known by its place alone.
msg::Scene SceneOf(const msg::Task& task) {
  msg::Scene scene;
  scene.X_WC = task.X_WC;
  msg::SceneObject object;
  object.id = task.object.object_id;
  object.centroid_W = task.centroid_W;
  scene.objects.push_back(object);
  return scene;
}

}  // namespace

Actions Conversation::Recover(Utime now) {
  latest_ = Event(msg::SessionKind::kIdle, now);
  if (const auto stopped = memory_.Stopped(); stopped) stopped_ = *stopped;
  const auto open = memory_.OpenTasks();
  if (!open) {
    Refuse(kSessionChannel, refusal::kStorage, open.error().message);
  } else {
    for (const msg::Task& task : *open) {
      tasks_.insert_or_assign(
          task.task_id,
          PendingTask{task, 0, SceneFollower(SceneOf(task), 0, config_.follow), 0, {}, true});
      if (task.expires_utime <= now) continue;
      latest_ = Event(msg::SessionKind::kConfirmed, now);
      latest_.session_id = task.task_id;
      latest_.user = task.user;
      latest_.questions = task.questions;
      latest_.text = DoneText(task);
    }
  }
  if (stopped_) {
    latest_ = Event(msg::SessionKind::kStopped, now);
    RevokeTasks(now);
  }
  Announce(msg::Session(latest_), now);
  RepeatTasks(now);
  return Taken();
}

void Conversation::Start(const msg::Session& request, Utime now) {
  if (stopped_) return Announce(msg::Session(latest_), now);
  if (const auto running = talks_.find(request.user); running != talks_.end()) {
    return AnnounceRunning(*running->second, now);
  }
  if (const msg::Session* ended = Ended(request.session_id)) {
    msg::Session again = *ended;
    again.utime = now;
    actions_.push_back(again);
    return;
  }
  const auto known = memory_.FindSession(request.session_id);
  if (!known) return Refuse(kSessionChannel, refusal::kStorage, known.error().message);
  if (known->has_value()) {
    msg::Session confirmed = Event(msg::SessionKind::kConfirmed, now);
    confirmed.session_id = request.session_id;
    confirmed.user = (*known)->user;
    confirmed.questions = (*known)->questions;
    confirmed.text =
        DoneText(TaskText(affordances_, (*known)->action, (*known)->category, config_.phrases));
    actions_.push_back(confirmed);
    return;
  }
  if (Talk* talk = NewTalk(request)) TryBegin(*talk, now);
}

/// Null: it was one too many.
Conversation::Talk* Conversation::NewTalk(const msg::Session& request) {
  if (static_cast<int>(talks_.size()) >= config_.max_sessions) {
    Refuse(kSessionChannel, refusal::kTooMany,
           "a session of '" + request.user + "' is one more than " +
               std::to_string(config_.max_sessions) + " at a time");
    return nullptr;
  }
  ++counters_.sessions;
  auto& talk = talks_[request.user] = std::make_unique<Talk>();
  talk->session_id = request.session_id;
  talk->user = request.user;
  talk->device = request.device;
  return talk.get();
}

/// Asks the first question as soon as scene and poses are there, or says what it waits for.
void Conversation::TryBegin(Talk& talk, Utime now) {
  if (!talk.table && !TakeScene(talk, now)) return;
  // Poses of its frame or of a later one: pose may skip scenes.
  if (poses_.utime < talk.scene_utime && now < talk.ask_by)
    return WaitFor(talk, Finished(config_.phrases.waiting_for_poses), now);
  talk.waits_for.clear();
  talk.interview = std::make_unique<Interview>(affordances_, policy_, InputOf(talk, now));
  AnnounceRunning(talk, now);
  Advance(talk, now);
}

void Conversation::WaitFor(Talk& talk, const std::string& what, Utime now) {
  if (talk.waits_for == what) return;
  talk.waits_for = what;
  AnnounceRunning(talk, now);
}

bool Conversation::TakeScene(Talk& talk, Utime now) {
  std::string missing;
  if (!HasScene(now)) {
    missing = Finished(config_.phrases.waiting_for_picture);
  } else if (!scene_->has_table) {
    missing = Finished(config_.phrases.waiting_for_table);
  } else if (scene_->objects.empty()) {
    missing = Finished(config_.phrases.waiting_for_objects);
  }
  if (!missing.empty()) {
    WaitFor(talk, missing, now);
    return false;
  }
  talk.table.emplace(*scene_, scene_arrived_, config_.follow);
  talk.scene_utime = scene_->utime;
  talk.ask_by = scene_arrived_ + config_.pose_wait;
  MatchPoses(talk);
  return true;
}

/// Says each name once; such objects count as unknown ones.
void Conversation::CheckCategory(const msg::SceneObject& object) {
  const std::string& name = object.category;
  if (name == msg::kUnknownCategory || affordances_.FindCategory(name) >= 0) return;
  ++counters_.unknown_categories;
  if (unknown_categories_.size() >= kMaxCategories || !unknown_categories_.insert(name).second)
    return;
  Refuse("BECKON_SCENE", refusal::kUnknown,
         "object " + std::to_string(object.id) + " is of the unknown category '" + name +
             "', it counts as Unknown; add it to affordances.toml");
}

InterviewInput Conversation::InputOf(Talk& talk, Utime now) {
  InterviewInput input;
  const auto sessions = memory_.SessionsOf(talk.user);
  if (!sessions) Refuse(kSessionChannel, refusal::kStorage, sessions.error().message);
  if (sessions) input.history = ToHistory(*sessions, affordances_);
  input.table = TableOf(talk);
  input.device = talk.device;
  input.devices = devices_;
  input.phrases = config_.phrases;
  input.utime = now;
  input.seed = Hash(talk.session_id);
  return input;
}

/// The sessions that have not asked anything yet. Each may end, and with it its talk.
void Conversation::BeginWaiting(Utime now) {
  for (Talk* talk : Talks()) {
    if (!talk->interview) TryBegin(*talk, now);
  }
}

Actions Conversation::OnPoses(const msg::Poses& poses, Utime now) {
  poses_ = poses;
  for (Talk* talk : Talks()) {
    if (talk->table) MatchPoses(*talk);
  }
  BeginWaiting(now);
  return Taken();
}

void Conversation::MatchPoses(Talk& talk) const {
  const auto& objects = talk.table->objects();
  for (const msg::ObjectPose& pose : poses_.poses) {
    if (!pose.converged) continue;
    for (size_t i = 0; i < objects.size(); ++i) {
      if (objects[i].gone || objects[i].object.id != pose.object_id) continue;
      if (IsNear(pose, objects[i])) talk.poses[static_cast<int>(i)] = pose;
    }
  }
}

Actions Conversation::OnInterface(const msg::Interface& announced, Utime) {
  if (devices_.size() >= kMostDevices && !devices_.contains(announced.device)) {
    Refuse("BECKON_INTERFACE", refusal::kTooMany,
           "'" + announced.device + "' is one front end too many");
    return Taken();
  }
  DeviceModel& model = devices_[announced.device];
  model.announced = true;
  model.kind = static_cast<InterfaceKind>(static_cast<int>(announced.kind) - 1);
  model.max_options = announced.max_options;
  model.seconds_per_question = announced.seconds_per_question;
  model.seconds_per_option = announced.seconds_per_option;
  model.rates = {announced.false_yes, announced.false_no};
  model.confusion = announced.confusion;
  if (model.confusion.size() == 2) {  // rows: meant yes, meant no
    model.rates = {model.confusion[1][0], model.confusion[0][1]};
  }
  for (auto& [user, talk] : talks_) {
    if (talk->interview) talk->interview->Know(announced.device, model);
  }
  return Taken();
}

}  // namespace beckon::intention
