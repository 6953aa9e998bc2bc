// What every way of asking looks like from outside: a policy begins a dialogue about a situation,
// the dialogue says what to ask next and hears answers until a candidate is accepted.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/base/utime.h"
#include "services/intention/core/affordances.h"
#include "services/intention/core/interface.h"
#include "services/intention/core/question.h"
#include "services/intention/core/situation.h"

namespace beckon::intention {

/// A confirmed session of a user.
struct PastSession {
  int category = 0;
  int action = 0;
  int rank = 1;
  std::map<std::string, AnswerCounts> answers;  // by device
  Utime utime = 0;                              // when it was confirmed; 0: not known
  std::vector<int> present;  // instances on the table, by category; empty: not known
};

/// Of one user, oldest first.
using UserHistory = std::vector<PastSession>;

struct Belief {
  int best_pair = -1;             // index in Situation::pairs, -1 where nothing is left
  double best_posterior = 0;      // 0..1
  int possible_pairs = 0;         // with a posterior above 1e-9
  double expected_questions = 0;  // still to be answered
  double expected_seconds = 0;    // that they take at this interface
  std::vector<double> posterior;  // by pair; empty where the policy has none
};

/// Whether a dialogue has anything left to ask, and if not, why.
enum class Ending {
  kOpen,    // it has
  kNone,    // none of the candidates is wanted: all were ruled out, or as good as
  kUnclear  // the answers make no sense: a switch that is stuck, or pure chance
};

/// One session. Deterministic: the same situation, history, seed and answers give the same
/// questions.
class Dialogue {
 public:
  virtual ~Dialogue() = default;

  /// The next question; nothing where every candidate was ruled out. Constant until Hear.
  virtual std::optional<Question> Ask() = 0;
  /// An answer to a question (not necessarily the last one asked).
  virtual void Hear(const Question& question, const Evidence& evidence) = 0;
  /// The accepted candidate: index in Situation::pairs.
  virtual std::optional<int> Accepted() const = 0;
  /// Why Ask has nothing to ask; kOpen where it has, or a candidate was accepted.
  virtual Ending End() const = 0;
  virtual Belief CurrentBelief() const = 0;
};

class Policy {
 public:
  virtual ~Policy() = default;
  /// `situation` must outlive the dialogue. `seed` decides ties.
  virtual std::unique_ptr<Dialogue> Begin(const Situation& situation, const UserHistory& history,
                                          const Interface& interface, uint64_t seed) const = 0;
};

/// Which questions may be asked.
enum class QueryFamilies {
  kActionObjectFull,  // the dissertation's
  kAll                // also categories and sets of objects
};

/// "adaptive", "oain", "count", "random", "random-scene"; fails on other names and on a
/// `lambda`, the learning rate of oain, that is not above 0. `affordances` must outlive the policy.
Result<std::unique_ptr<Policy>> MakePolicy(const std::string& name, const Affordances& affordances,
                                           QueryFamilies families, double lambda = 1);

}  // namespace beckon::intention
