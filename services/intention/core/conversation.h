// The conversation of docs/protocol.md as a state machine: events in with the time, messages out.
// No bus, no clock, no files; what must be remembered goes through Memory before anything is
// promised.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "services/base/refusal.h"
#include "services/intention/core/interview.h"
#include "services/intention/core/label_match.h"
#include "services/intention/core/memory.h"
#include "services/intention/core/policy.h"
#include "services/intention/core/scene_follower.h"

namespace beckon::intention {

struct ConversationConfig {
  Utime query_period = kSecond / 2;
  Utime announce_period = kSecond;
  Utime task_period = kSecond / 2;
  Utime task_lifetime = 30 * kSecond;
  Utime label_period = kSecond / 2;
  Utime label_lifetime = 30 * kSecond;   // after its session; a label that perception took is over
  Utime retract_lifetime = 5 * kSecond;  // nothing shows that it was heard
  Utime scene_max_age = 5 * kSecond;     // since it arrived
  Utime pose_wait = kSecond;             // most that the first query waits for poses, likewise
  double pose_place_m = 0.10;            // most between a pose and the object it is for
  int max_sessions = 16;                 // users at a time
  LabelMatchConfig labels;
  FollowConfig follow;  // of the table while a session lasts
  Phrases phrases = English();
};

/// A message that was well formed but wrong, or that could not be heeded.
struct Refused {
  std::string channel;
  std::string reason;  // one of services/base/refusal.h
  std::string detail;
};

/// Unsealed messages, to be published in this order.
using Outgoing = std::variant<msg::Query, msg::Session, msg::Task, msg::TaskStatus, msg::Label,
                              msg::Profile, msg::Lease, Refused>;
using Actions = std::vector<Outgoing>;

struct ConversationCounters {
  int64_t sessions = 0;  // begun
  int64_t confirmed = 0;
  int64_t abandoned = 0;
  int64_t answers = 0;  // taken
  int64_t stale_answers = 0;
  int64_t refused = 0;  // other messages
  int64_t tasks = 0;    // published the first time
  int64_t expired = 0;
  int64_t revoked = 0;             // tasks whose object went or moved before a robot took them
  int64_t held = 0;                // confirmations that waited for their object to be seen
  int64_t labels = 0;              // told to perception, or taken back, the first time
  int64_t late_scenes = 0;         // older than one that was there already
  int64_t unknown_categories = 0;  // objects of sessions, of a category not in the affordances
};

/// Whether what a user confirmed may be promised and done at this very moment.
using MayAct = std::function<bool(const std::string& user)>;

class Conversation {
 public:
  /// Everything passed in must outlive the conversation. While `may_act` says no, what a user
  /// accepted waits.
  Conversation(
      const Affordances& affordances, const Policy& policy, Memory& memory,
      const ConversationConfig& config = {}, MayAct may_act = [](const auto&) { return true; });
  ~Conversation();

  /// Takes up what an earlier run left: open tasks, the stopped state. Call once, first.
  Actions Recover(Utime now);

  Actions OnScene(const msg::Scene& scene, Utime now);
  Actions OnPoses(const msg::Poses& poses, Utime now);
  Actions OnInterface(const msg::Interface& announced, Utime now);
  Actions OnAnswer(const msg::Answer& answer, Utime now);
  Actions OnSession(const msg::Session& request, Utime now);
  Actions OnTaskStatus(const msg::TaskStatus& status, Utime now);
  /// Repeats what is due; call every 0.1 s.
  Actions Tick(Utime now);

  // Several services lead conversations on one bus, see LedConversation.
  /// Begins anew, with the same id, a session that was led elsewhere, and says so.
  Actions TakeOver(const msg::Session& request, Utime now);
  /// Drops the user's session without a word: another leads it.
  void Withdraw(const std::string& user);
  /// A session of another service ended (CONFIRMED or ABANDONED).
  void NoteEnd(const msg::Session& event);
  bool Runs(const std::string& user) const { return talks_.contains(user); }
  /// Whose session runs under this id.
  std::optional<std::string> UserOf(const std::string& session_id) const;
  /// Whether a session of this id ended, or may have: the memory fails.
  bool IsOver(const std::string& session_id) const;
  bool HasScene(Utime now) const { return scene_ && now - scene_arrived_ <= config_.scene_max_age; }
  /// What is said of a task that was confirmed.
  std::string DoneText(const msg::Task& task) const;

  const ConversationCounters& counters() const { return counters_; }
  bool stopped() const { return stopped_; }
  /// One line for people.
  std::string StateText() const;

 private:
  struct Talk;         // a running session
  struct PendingTask;  // published and not yet acknowledged
  /// Published, and not yet seen in a SCENE.
  struct PendingLabel {
    msg::Label label;
    Utime sent = 0;
    Utime until = 0;  // 0: as long as its session runs
  };
  using RequestIdentity = std::tuple<msg::SessionKind, std::string, std::string, Utime>;

  void Start(const msg::Session& request, Utime now);
  Talk* NewTalk(const msg::Session& request);
  void TryBegin(Talk& talk, Utime now);
  /// Takes the newest scene. False: it went on waiting for one.
  bool TakeScene(Talk& talk, Utime now);
  void WaitFor(Talk& talk, const std::string& what, Utime now);
  void CheckCategory(const msg::SceneObject& object);
  InterviewInput InputOf(Talk& talk, Utime now);
  /// The table as the talk knows it now; looks up what is remembered of new objects.
  std::vector<TableObject> TableOf(Talk& talk);
  bool IsLate(const msg::Scene& scene, Utime now) const;
  /// The newest scene, as far as it concerns running sessions. Each may end, and with it its talk.
  void FollowScene(Utime now);
  void Follow(Talk& talk, Utime now);
  /// Confirmations whose object was not seen when they came.
  void Recheck(Talk& talk, Utime now);
  std::string WhatBecameOfIt(const Talk& talk, const std::vector<TableObject>& table) const;
  bool HoldBack(Talk& talk, const AcceptedTask& accepted, Utime now);
  void WatchTasks(Utime now);
  bool IsInView(const PendingTask& pending) const;
  void RevokeTask(PendingTask& pending, const std::string& text, Utime now);
  bool IsFresh(const SceneFollower& table, Utime now) const;
  std::vector<Talk*> Talks();
  void BeginWaiting(Utime now);
  /// Tells perception what the user said the objects are: what is new, and what was taken back.
  void TellLabels(Talk& talk, Utime now);
  /// The session is over, and its labels are not kept.
  void RetractLabels(Talk& talk, Utime now);
  void EndLabels(const Talk& talk, Utime now);
  void SendLabel(const Talk& talk, const LabelRecord& said, int object, msg::LabelState state,
                 Utime now);
  /// Says by which id perception knows the object, where the newest scene shows it.
  void PointAt(const Talk& talk, int object, msg::Label& label) const;
  void RepeatLabels(Utime now);
  void Advance(Talk& talk, Utime now);
  /// Publishes what the interview came to.
  void Put(Talk& talk, Utime now);
  void Confirm(Talk& talk, const AcceptedTask& accepted, Utime now);
  void Abandon(Talk& talk, const std::string& text, Utime now, bool keep_labels);
  void End(std::string user);
  void Remember(const msg::Session& end);
  void Stop(const msg::Session& request, Utime now);
  void Resume(const msg::Session& request, Utime now);
  /// Tells front ends of a user's past.
  void TellProfile(const std::string& user, Utime now);
  void TellProfiles(Utime now);
  void RevokeTasks(Utime now);
  void TellTask(PendingTask& pending, Utime now);
  void RepeatTasks(Utime now);

  msg::Task MakeTask(const Talk& talk, const AcceptedTask& accepted, Utime now) const;
  std::vector<LabelRecord> LabelsOf(const Talk& talk, Utime now) const;
  Talk* Find(const msg::Session& request);
  /// Whether this very request came before; remembers it.
  bool Seen(const msg::Session& request);
  const msg::Session* Ended(const std::string& session_id) const;
  void Announce(const msg::Session& event, Utime now);
  void AnnounceRunning(Talk& talk, Utime now);
  msg::Session Event(msg::SessionKind kind, Utime now) const;
  std::string DoneText(const std::string& task) const;
  void Refuse(const std::string& channel, const std::string& reason, const std::string& detail);
  void MatchPoses(Talk& talk) const;
  /// Whether a pose may be this object's.
  bool IsNear(const msg::ObjectPose& pose, const Followed& object) const;
  Actions Taken();

  const Affordances& affordances_;
  const Policy& policy_;
  Memory& memory_;
  const ConversationConfig config_;
  const MayAct may_act_;

  Actions actions_;  // of the event being handled
  ConversationCounters counters_;
  std::map<std::string, std::unique_ptr<Talk>> talks_;  // by user
  std::map<std::string, PendingTask> tasks_;            // by task id
  std::map<std::string, PendingLabel> labels_;          // by label id
  std::map<std::string, DeviceModel> devices_;
  std::deque<RequestIdentity> seen_;          // the last few requests
  std::deque<msg::Session> ended_;            // the last few outcomes, newest at the back
  std::map<std::string, bool> profiled_;      // users whose profile was asked for; true: it is due
  std::set<std::string> unknown_categories_;  // that were complained about
  msg::Session latest_;                       // the event that is announced while nothing runs
  Utime latest_announced_ = 0;
  std::optional<msg::Scene> scene_;
  Utime scene_arrived_ = 0;
  msg::Poses poses_;
  int64_t last_query_id_ = 0;
  bool stopped_ = false;
};

}  // namespace beckon::intention
