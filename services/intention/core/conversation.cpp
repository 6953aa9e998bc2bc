#include "services/intention/core/conversation.h"

#include <algorithm>

namespace beckon::intention {
namespace {

constexpr char kSessionChannel[] = "BECKON_SESSION";
constexpr char kAnswerChannel[] = "BECKON_ANSWER";
constexpr size_t kRememberedEnds = 32;
constexpr size_t kMostDevices = 64;

/// FNV-1a: the same session has the same ties everywhere.
uint64_t Hash(const std::string& text) {
  uint64_t hash = 14695981039346656037ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  return hash;
}

}  // namespace

/// A running session.
struct Conversation::Talk {
  std::string session_id;
  std::string user;
  std::string device;
  std::string waits_for;  // empty once it has a scene
  std::vector<std::string> remembered;
  msg::Scene scene;
  std::map<int, msg::ObjectPose> poses;  // by index of the scene's object
  std::unique_ptr<Interview> interview;
  std::optional<msg::Query> query;
  Utime query_sent = 0;
  Utime announced = 0;
  std::optional<std::pair<std::string, Utime>> last_request;  // device and time, to know duplicates
};

struct Conversation::PendingTask {
  msg::Task task;
  Utime sent = 0;
};

Conversation::Conversation(const Affordances& affordances, const Policy& policy, Memory& memory,
                           const ConversationConfig& config)
    : affordances_(affordances), policy_(policy), memory_(memory), config_(config) {}

Conversation::~Conversation() = default;

Actions Conversation::Taken() { return std::exchange(actions_, {}); }

void Conversation::Refuse(const std::string& channel, const std::string& detail) {
  ++counters_.refused;
  actions_.push_back(Refused{channel, detail});
}

msg::Session Conversation::Event(msg::SessionKind kind, Utime now) const {
  msg::Session event;
  event.utime = now;
  event.kind = kind;
  return event;
}

void Conversation::Announce(const msg::Session& event, Utime now) {
  latest_ = event;
  latest_announced_ = now;
  actions_.push_back(event);
}

void Conversation::AnnounceRunning(Talk& talk, Utime now) {
  msg::Session event = Event(msg::SessionKind::kBegun, now);
  event.session_id = talk.session_id;
  event.user = talk.user;
  event.questions = talk.interview ? talk.interview->questions() : 0;
  event.text = talk.waits_for;
  talk.announced = now;
  actions_.push_back(event);
}

const msg::Session* Conversation::Ended(const std::string& session_id) const {
  for (const msg::Session& event : ended_) {
    if (event.session_id == session_id) return &event;
  }
  return nullptr;
}

Conversation::Talk* Conversation::Find(const msg::Session& request) {
  const auto found = talks_.find(request.user);
  if (found == talks_.end() || found->second->session_id != request.session_id) return nullptr;
  return found->second.get();
}

// ---- Beginning
// ------------------------------------------------------------------------------------

Actions Conversation::Recover(Utime now) {
  latest_ = Event(msg::SessionKind::kIdle, now);
  if (const auto stopped = memory_.Stopped(); stopped) stopped_ = *stopped;
  const auto open = memory_.OpenTasks();
  if (!open) {
    Refuse(kSessionChannel, open.error().message);
  } else {
    for (const msg::Task& task : *open) {
      tasks_[task.task_id] = {task, 0};
      if (task.expires_utime <= now) continue;
      latest_ = Event(msg::SessionKind::kConfirmed, now);
      latest_.session_id = task.task_id;
      latest_.user = task.user;
      latest_.questions = task.questions;
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
  if (!known) return Refuse(kSessionChannel, known.error().message);
  if (known->has_value()) {
    msg::Session confirmed = Event(msg::SessionKind::kConfirmed, now);
    confirmed.session_id = request.session_id;
    confirmed.user = (*known)->user;
    confirmed.questions = (*known)->questions;
    actions_.push_back(confirmed);
    return;
  }
  if (static_cast<int>(talks_.size()) >= config_.max_sessions) {
    return Refuse(kSessionChannel, "a session of '" + request.user + "' is one more than " +
                                       std::to_string(config_.max_sessions) + " at a time");
  }
  ++counters_.sessions;
  auto& talk = talks_[request.user] = std::make_unique<Talk>();
  talk->session_id = request.session_id;
  talk->user = request.user;
  talk->device = request.device;
  TryBegin(*talk, now);
}

/// Takes the newest scene, or says what it waits for.
void Conversation::TryBegin(Talk& talk, Utime now) {
  const std::string waited_for = talk.waits_for;
  talk.waits_for.clear();
  if (!scene_ || now - scene_arrived_ > config_.scene_max_age) {
    talk.waits_for = "Waiting for a picture of the table.";
  } else if (!scene_->has_table) {
    talk.waits_for = "Waiting until the table is in view.";
  } else if (scene_->objects.empty()) {
    talk.waits_for = "Waiting for objects on the table.";
  }
  if (!talk.waits_for.empty()) {
    if (talk.waits_for != waited_for) AnnounceRunning(talk, now);
    return;
  }
  talk.scene = *scene_;
  if (talk.scene.objects.size() > kMaxThings) talk.scene.objects.resize(kMaxThings);
  InterviewInput input;
  const auto labels = memory_.LabelsOf(talk.scene.source);
  const auto sessions = memory_.SessionsOf(talk.user);
  if (!labels) Refuse(kSessionChannel, labels.error().message);
  if (!sessions) Refuse(kSessionChannel, sessions.error().message);
  for (const msg::SceneObject& object : talk.scene.objects) {
    const LabelRecord* label =
        labels ? FindLabel(*labels, talk.scene.source, object, config_.labels) : nullptr;
    input.remembered.push_back(label == nullptr ? "" : label->category);
    if (object.category != msg::kUnknownCategory &&
        affordances_.FindCategory(object.category) < 0) {
      Refuse("BECKON_SCENE", "object " + std::to_string(object.id) +
                                 " is of the unknown category '" + object.category +
                                 "'; add it to affordances.toml");
    }
  }
  if (sessions) input.history = ToHistory(*sessions, affordances_);
  input.scene = talk.scene;
  input.device = talk.device;
  input.devices = devices_;
  input.seed = Hash(talk.session_id);
  talk.interview = std::make_unique<Interview>(affordances_, policy_, std::move(input));
  MatchPoses(talk);
  AnnounceRunning(talk, now);
  Advance(talk, now);
}

Actions Conversation::OnScene(const msg::Scene& scene, Utime now) {
  scene_ = scene;
  scene_arrived_ = now;
  std::vector<Talk*> waiting;
  for (auto& [user, talk] : talks_) {
    if (!talk->interview) waiting.push_back(talk.get());
  }
  for (Talk* talk : waiting) TryBegin(*talk, now);
  return Taken();
}

Actions Conversation::OnPoses(const msg::Poses& poses, Utime) {
  poses_ = poses;
  for (auto& [user, talk] : talks_) {
    if (talk->interview) MatchPoses(*talk);
  }
  return Taken();
}

void Conversation::MatchPoses(Talk& talk) const {
  for (const msg::ObjectPose& pose : poses_.poses) {
    if (!pose.converged) continue;
    for (size_t i = 0; i < talk.scene.objects.size(); ++i) {
      const msg::SceneObject& object = talk.scene.objects[i];
      if (object.id != pose.object_id) continue;
      if ((pose.X_WO.translation() - object.centroid_W).norm() > config_.pose_place_m) continue;
      talk.poses[static_cast<int>(i)] = pose;
    }
  }
}

Actions Conversation::OnInterface(const msg::Interface& announced, Utime) {
  if (devices_.size() >= kMostDevices && !devices_.contains(announced.device)) {
    Refuse("BECKON_INTERFACE", "'" + announced.device + "' is one front end too many");
    return Taken();
  }
  DeviceModel& model = devices_[announced.device];
  model.announced = true;
  model.max_options = announced.max_options;
  model.rates = {announced.false_yes, announced.false_no};
  model.confusion = announced.confusion;
  for (auto& [user, talk] : talks_) {
    if (talk->interview) talk->interview->Know(announced.device, model);
  }
  return Taken();
}

// ---- Asking
// ---------------------------------------------------------------------------------------

/// Publishes what the interview came to.
void Conversation::Advance(Talk& talk, Utime now) {
  const Interview::Outcome& outcome = talk.interview->outcome();
  if (const auto* accepted = std::get_if<AcceptedTask>(&outcome))
    return Confirm(talk, *accepted, now);
  if (const auto* gave_up = std::get_if<GaveUp>(&outcome))
    return Abandon(talk, gave_up->text, now, true);
  msg::Query query = std::get<msg::Query>(outcome);
  query.utime = now;
  query.id = last_query_id_ = std::max(last_query_id_ + 1, now);
  query.session_id = talk.session_id;
  query.user = talk.user;
  query.scene_seq = talk.scene.seq;
  query.questions_asked = talk.interview->questions();
  talk.query = query;
  talk.query_sent = now;
  actions_.push_back(std::move(query));
}

Actions Conversation::OnAnswer(const msg::Answer& answer, Utime now) {
  const auto found = std::find_if(talks_.begin(), talks_.end(), [&](const auto& entry) {
    return entry.second->query && entry.second->query->id == answer.query_id &&
           entry.second->session_id == answer.session_id;
  });
  if (found == talks_.end()) {
    ++counters_.stale_answers;
    actions_.push_back(Refused{
        kAnswerChannel,
        "answer to query " + std::to_string(answer.query_id) + ", which is not the current one"});
    if (const msg::Session* ended = Ended(answer.session_id)) actions_.push_back(*ended);
    return Taken();
  }
  Talk& talk = *found->second;
  if (answer.likelihoods.size() != talk.query->options.size()) {
    Refuse(kAnswerChannel, "answer with " + std::to_string(answer.likelihoods.size()) +
                               " likelihoods to a query with " +
                               std::to_string(talk.query->options.size()) + " options");
    return Taken();
  }
  ++counters_.answers;
  talk.interview->Answer(answer.likelihoods, answer.device);
  Advance(talk, now);
  return Taken();
}

Actions Conversation::OnSession(const msg::Session& request, Utime now) {
  using Kind = msg::SessionKind;
  switch (request.kind) {
    case Kind::kRequestStart:
      Start(request, now);
      return Taken();
    case Kind::kRequestStop:
      Stop(request, now);
      return Taken();
    case Kind::kRequestResume:
      Resume(now);
      return Taken();
    case Kind::kRequestCancel:
    case Kind::kRequestUndo:
    case Kind::kRequestNoneOfThese:
      break;
    default:
      return Taken();  // an event, our own
  }
  Talk* talk = Find(request);
  if (talk == nullptr) {
    if (const msg::Session* ended = Ended(request.session_id)) {
      actions_.push_back(*ended);
    } else {
      Refuse(kSessionChannel,
             "request for session '" + request.session_id + "', which does not run");
    }
    return Taken();
  }
  if (request.kind == Kind::kRequestCancel) {
    Abandon(*talk, "Cancelled.", now, false);
    return Taken();
  }
  const std::pair identity{request.device, request.utime};
  if (!talk->interview || talk->last_request == identity) return Taken();
  talk->last_request = identity;
  if (request.kind == Kind::kRequestNoneOfThese) {
    ++counters_.answers;
    talk->interview->NoneOfThese(request.device);
  } else if (!talk->interview->Undo()) {
    return Taken();
  }
  Advance(*talk, now);
  return Taken();
}

// ---- Ending
// ---------------------------------------------------------------------------------------

std::vector<LabelRecord> Conversation::LabelsOf(const Talk& talk, Utime now) const {
  std::vector<LabelRecord> records;
  for (const GivenLabel& label : talk.interview->Labels()) {
    const msg::SceneObject& object = talk.scene.objects[label.object];
    LabelRecord record;
    record.id = talk.session_id + "/label/" + std::to_string(object.id);
    record.session_id = talk.session_id;
    record.user = talk.user;
    record.utime = now;
    record.category = label.category;
    record.source = talk.scene.source;
    record.centroid_W = object.centroid_W;
    record.extent_W = object.extent_W;
    record.probabilities = object.probabilities;
    records.push_back(std::move(record));
  }
  return records;
}

msg::Task Conversation::MakeTask(const Talk& talk, const AcceptedTask& accepted, Utime now) const {
  const msg::SceneObject& object = talk.scene.objects[accepted.object];
  msg::Task task;
  task.utime = now;
  task.task_id = talk.session_id;
  task.user = talk.user;
  task.action = accepted.action;
  task.object = {object.id, accepted.category, accepted.instance};
  task.centroid_W = object.centroid_W;
  task.pose.object_id = object.id;
  if (const auto pose = talk.poses.find(accepted.object); pose != talk.poses.end()) {
    task.has_pose = true;
    task.pose = pose->second;
  }
  task.X_WC = talk.scene.X_WC;
  task.posterior = std::min(accepted.posterior, 1.0);
  task.questions = talk.interview->questions();
  task.expires_utime = now + config_.task_lifetime;
  return task;
}

/// On disk first, then the task.
void Conversation::Confirm(Talk& talk, const AcceptedTask& accepted, Utime now) {
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
  record.answers = talk.interview->Answers();
  const msg::Task task = MakeTask(talk, accepted, now);
  const auto committed = memory_.Commit(record, LabelsOf(talk, now), task);
  if (!committed) {
    return Abandon(talk,
                   "It could not be remembered, so nothing was done: " + committed.error().message,
                   now, false);
  }
  if (*committed) {
    ++counters_.confirmed;
    ++counters_.tasks;
    tasks_[task.task_id] = {task, now};
    actions_.push_back(task);
  }
  msg::Session event = Event(msg::SessionKind::kConfirmed, now);
  event.session_id = record.session_id;
  event.user = record.user;
  event.questions = record.questions;
  event.text = accepted.text + ".";
  Announce(event, now);
  End(talk.user);
}

void Conversation::Abandon(Talk& talk, const std::string& text, Utime now, bool keep_labels) {
  ++counters_.abandoned;
  if (keep_labels && talk.interview) {
    if (Status kept = memory_.CommitLabels(LabelsOf(talk, now)); !kept) {
      Refuse(kSessionChannel, kept.error().message);
    }
  }
  msg::Session event = Event(msg::SessionKind::kAbandoned, now);
  event.session_id = talk.session_id;
  event.user = talk.user;
  event.questions = talk.interview ? talk.interview->questions() : 0;
  event.text = text;
  Announce(event, now);
  End(talk.user);
}

void Conversation::End(std::string user) {
  ended_.push_back(latest_);
  if (ended_.size() > kRememberedEnds) ended_.pop_front();
  talks_.erase(user);
}

void Conversation::Stop(const msg::Session& request, Utime now) {
  if (stopped_) return Announce(msg::Session(latest_), now);
  stopped_ = true;
  msg::Session event = Event(msg::SessionKind::kStopped, now);
  event.session_id = request.session_id;
  event.user = request.user;
  event.text = "Stopped. Only \"resume\" leads on.";
  Announce(event, now);
  talks_.clear();
  if (Status set = memory_.SetStopped(true, now); !set)
    Refuse(kSessionChannel, set.error().message);
  RevokeTasks(now);
}

void Conversation::RevokeTasks(Utime now) {
  for (const auto& [id, pending] : tasks_) {
    actions_.push_back(
        msg::TaskStatus{now, id, msg::TaskState::kRevoked, "The user stopped everything.", {}});
    if (Status noted = memory_.NoteTask(id, msg::TaskState::kRevoked, now); !noted) {
      Refuse(kSessionChannel, noted.error().message);
    }
  }
  tasks_.clear();
}

void Conversation::Resume(Utime now) {
  if (!stopped_) return;
  if (Status set = memory_.SetStopped(false, now); !set)
    return Refuse(kSessionChannel, set.error().message);
  stopped_ = false;
  Announce(Event(msg::SessionKind::kIdle, now), now);
}

// ---- Repeating
// ------------------------------------------------------------------------------------

Actions Conversation::OnTaskStatus(const msg::TaskStatus& status, Utime now) {
  const auto pending = tasks_.find(status.task_id);
  if (pending == tasks_.end()) return Taken();
  if (Status noted = memory_.NoteTask(status.task_id, status.state, now); !noted) {
    Refuse("BECKON_TASK_STATUS", noted.error().message);
  }
  tasks_.erase(pending);
  return Taken();
}

void Conversation::RepeatTasks(Utime now) {
  for (auto entry = tasks_.begin(); entry != tasks_.end();) {
    auto& [id, pending] = *entry;
    if (pending.task.expires_utime <= now) {
      ++counters_.expired;
      actions_.push_back(msg::TaskStatus{
          now, id, msg::TaskState::kExpired, "No robot took the task in time.", {}});
      if (Status noted = memory_.NoteTask(id, msg::TaskState::kExpired, now); !noted) {
        Refuse("BECKON_TASK_STATUS", noted.error().message);
      }
      entry = tasks_.erase(entry);
      continue;
    }
    if (now - pending.sent >= config_.task_period) {
      pending.sent = now;
      actions_.push_back(pending.task);
    }
    ++entry;
  }
}

Actions Conversation::Tick(Utime now) {
  std::vector<Talk*> waiting;
  for (auto& [user, talk] : talks_) {
    if (!talk->interview) waiting.push_back(talk.get());
    if (talk->query && now - talk->query_sent >= config_.query_period) {
      talk->query_sent = now;
      actions_.push_back(*talk->query);
    }
    if (now - talk->announced >= config_.announce_period) AnnounceRunning(*talk, now);
  }
  // A scene that was fresh when it was waited for may have grown old.
  for (Talk* talk : waiting) TryBegin(*talk, now);
  if (now - latest_announced_ >= config_.announce_period && (stopped_ || talks_.empty())) {
    latest_.utime = now;
    Announce(msg::Session(latest_), now);
  }
  RepeatTasks(now);
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
