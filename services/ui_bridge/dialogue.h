// One front end's side of the conversation (docs/protocol.md, "Conversing"): when to ask for a
// session, which question to present, what to repeat until it has arrived, and how to go on when
// intention was away. Every front end uses this one; none has rules of its own.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/base/utime.h"

namespace beckon::ui_bridge {

struct DialogueConfig {
  std::string user;                // whose wishes; 1 .. 64 of [A-Za-z0-9_.-]
  std::string device;              // this front end
  Utime listen_us = 1'500'000;     // before the first request: join what runs already
  Utime repeat_us = 500'000;       // of what may have been lost
  Utime silence_us = 4 * kSecond;  // without a word of intention: tell the user
  Utime lost_us = 3 * kSecond;     // intention speaks, but not of our session: it forgot it
};

/// What a dialogue wants done: `Send` goes to the bus, the rest to the user.
class DialogueOutput {
 public:
  virtual ~DialogueOutput() = default;
  virtual void Send(const msg::Answer& answer) = 0;
  virtual void Send(const msg::Session& request) = 0;
  /// Called once for each question.
  virtual void Present(const msg::Query& query) = 0;
  /// The question presented last no longer stands.
  virtual void Withdraw() = 0;
  /// Called when the event changes, not when it is repeated.
  virtual void ShowSession(const msg::Session& event) = 0;
  /// Whose wishes count from now on, after ChangeUser.
  virtual void ShowUser(const std::string& user) = 0;
  /// A line for the user.
  virtual void ShowNotice(const std::string& text) = 0;
};

/// `clock` stamps messages; `steady` paces repetitions and never goes back. Both, and `output`,
/// must outlive the dialogue. Not thread-safe.
class Dialogue {
 public:
  enum class Phase { kIdle, kRequesting, kRunning, kStopped };

  Dialogue(DialogueConfig config, const Clock& clock, const Clock& steady,
           std::function<std::string()> new_session_id, DialogueOutput& output);

  /// Call at least every 100 ms.
  void Tick();
  void OnQuery(const msg::Query& query);
  /// Events of intention; requests of other front ends are left alone.
  void OnSession(const msg::Session& event);

  /// The user wants a session: begun as soon as listening is over, none runs and nothing is
  /// stopped.
  void Start();
  /// Evidence for the options of the question presented; ignored where another or none stands, or
  /// where an undo is on its way.
  void Answer(int64_t query_id, const std::vector<double>& likelihoods);
  /// Both are repeated until the number of answers shows that they arrived, one after the other and
  /// after an answer that is on its way.
  void Undo();
  void NoneOfThese();
  void Cancel();
  /// From now on nothing is answered and nothing asked; only Resume, once intention has stopped,
  /// leads out of it.
  void Stop();
  void Resume();
  /// Somebody else's wishes from now on. A session that runs is cancelled first; `user` changes
  /// when that was heard.
  void ChangeUser(const std::string& user);

  const std::string& user() const { return config_.user; }
  Phase phase() const { return phase_; }
  const std::string& session_id() const { return session_id_; }
  /// The question that stands; null where none does.
  const msg::Query* query() const { return query_ ? &*query_ : nullptr; }
  bool answered() const { return answer_.has_value(); }

 private:
  template <typename T>
  struct Repeated {
    T message;
    Utime due;
  };

  void BeginRequesting();
  void TakeNextUser();
  void Join(const std::string& session_id);
  void End();
  void DropQuery();
  void ShowOnce(const msg::Session& event);
  /// A service that is not the one we hear of our session from, or of the stop, has nothing to do.
  bool IsBystander(const msg::Session& idle) const;
  void OnIdle(const msg::Session& event);
  void OnEnd(const msg::Session& event);
  /// Intention speaks, but no longer of the session that runs.
  void CheckLost(Utime now);
  void Insist(msg::SessionKind kind);
  /// Intention has not said yet that it stopped.
  bool Stopping() const;
  /// Forgets what was to be asked or said.
  void LayDown();
  void Change(msg::SessionKind kind);
  void SendNextChange();
  void ForgetChanges();
  /// Intention's count of the answers so far.
  void HearCount(int questions);
  bool HasEnded(const std::string& session_id) const;
  msg::Session Request(msg::SessionKind kind) const;

  DialogueConfig config_;
  const Clock& clock_;
  const Clock& steady_;
  const std::function<std::string()> new_session_id_;
  DialogueOutput& output_;

  Phase phase_ = Phase::kIdle;
  bool wanted_ = false;                   // the user wants a session
  std::optional<std::string> next_user_;  // once the session that runs is cancelled
  bool cancelled_ = false;                // the user no longer wants the one that runs
  Utime listen_until_;
  std::string session_id_;
  std::string leader_;  // seal_t.sender of what was last said to us
  std::optional<msg::Query> query_;
  std::set<int64_t> presented_;  // ids of this session
  std::optional<Repeated<msg::Answer>> answer_;
  std::optional<Repeated<msg::Session>> start_;
  std::optional<Repeated<msg::Session>> control_;  // cancel, stop or resume
  std::deque<msg::SessionKind> changes_;           // undo, none of these: still to be said
  std::optional<Repeated<msg::Session>> change_;   // the one that is being said
  int questions_ = 0;                              // answers so far, as intention counts them
  std::deque<std::string> ended_;                  // the latest sessions that are over
  std::optional<msg::Session> shown_;
  Utime heard_;       // when intention last said anything
  Utime ours_heard_;  // when it last spoke of the session that runs
  bool silent_ = false;
};

}  // namespace beckon::ui_bridge
