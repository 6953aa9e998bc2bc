// Living recorded or made-up sessions with a policy and a user who answers truthfully but for
// slips.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "services/intention/core/policy.h"

namespace beckon::intention {

struct ScenarioSession {
  std::string user;
  std::vector<Thing> scene;
  int want_category = 0;
  int want_rank = 1;
  int want_action = 0;
  Utime utime = 0;  // 0: not known
};

struct EvaluationConfig {
  double flip = 0;  // P(an answer is not what was meant: the opposite, or any other), 0..0.5
  // What the policy is told of it. Without: with flip 0 that answers are never wrong (as an
  // interface does that announces no errors), else only that they may be wrong, and it learns how
  // often.
  std::optional<double> assume_flip;
  Interface interface;  // but for its errors, which `flip` and `assume_flip` give
  uint64_t seed = 1;
  int most_questions = 500;  // a session that takes more is given up
};

struct SessionOutcome {
  int questions = 0;
  double seconds = 0;                   // that the questions took at the interface
  std::optional<PastSession> answered;  // category, action and rank that were accepted
  bool correct = false;
  double posterior = 0;
  double compute_us = 0;  // spent in the policy
};

/// A session that is being lived.
struct SessionView {
  const ScenarioSession& session;
  const Situation& situation;
  const UserHistory& history;  // before it
  const Interface& interface;
  int wanted;  // index in situation.pairs
};

struct AnsweredQuestion {
  Question question;
  Belief before;
  int answer = 0;
  Belief after;
};

/// Looks on. What it does is not counted as the policy's time.
class SessionWatcher {
 public:
  virtual ~SessionWatcher() = default;
  virtual void Begun(const SessionView& view, const Belief& belief) = 0;
  virtual void Answered(const SessionView& view, const AnsweredQuestion& answered) = 0;
  virtual void Ended(const SessionView& view, const SessionOutcome& outcome) = 0;
};

/// Users start fresh and live their sessions in order; what was accepted is learnt, right or wrong.
/// `now_us` is a stopwatch.
class Evaluation {
 public:
  Evaluation(const Affordances& affordances, const Policy& policy, const EvaluationConfig& config,
             std::function<double()> now_us);

  /// The next line of the scenario. The wanted pair must be among the scene's. `watcher` may be
  /// null.
  SessionOutcome Live(const ScenarioSession& session, SessionWatcher* watcher = nullptr);

 private:
  struct User {
    std::string name;
    UserHistory history;
  };
  User& Find(const std::string& name);
  Interface InterfaceOf(const User& user) const;

  const Affordances& affordances_;
  const Policy& policy_;
  const EvaluationConfig config_;
  const std::function<double()> now_us_;
  std::vector<User> users_;
  uint64_t sessions_ = 0;
};

}  // namespace beckon::intention
