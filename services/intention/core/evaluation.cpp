#include "services/intention/core/evaluation.h"

#include <algorithm>
#include <random>

#include "services/intention/core/answer_errors.h"

namespace beckon::intention {
namespace {

/// Uniform in [0, 1), the same on every platform.
double Uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1.0p-53; }

}  // namespace

Evaluation::Evaluation(const Affordances& affordances, const Policy& policy,
                       const EvaluationConfig& config, std::function<double()> now_us)
    : affordances_(affordances), policy_(policy), config_(config), now_us_(std::move(now_us)) {}

Evaluation::User& Evaluation::Find(const std::string& name) {
  const auto found =
      std::find_if(users_.begin(), users_.end(), [&](const User& u) { return u.name == name; });
  if (found != users_.end()) return *found;
  users_.push_back({name, {}});
  return users_.back();
}

ErrorModel Evaluation::Errors(const User& user) const {
  if (config_.assume_flip) return ErrorModel::Exact({*config_.assume_flip, *config_.assume_flip});
  if (config_.flip <= 0) return ErrorModel::Exact({});
  return ErrorModel::Unknown().Learnt(PastAnswers(user.history, ""));
}

SessionOutcome Evaluation::Live(const ScenarioSession& session) {
  User& user = Find(session.user);
  const uint64_t seed = config_.seed * 1'000'003 + sessions_++;
  std::mt19937_64 random(seed);
  const Situation situation = MakeSituation(affordances_, session.scene);
  const int want = situation.Find(session.want_category, session.want_rank, session.want_action);

  SessionOutcome outcome;
  struct Said {
    Question question;
    bool yes;
  };
  std::vector<Said> said;
  double started = now_us_();
  const ErrorModel errors = Errors(user);
  const auto dialogue = policy_.Begin(situation, user.history, errors, seed);
  while (outcome.questions < config_.most_questions) {
    const auto question = dialogue->Ask();
    outcome.compute_us += now_us_() - started;
    started = now_us_();
    if (!question) break;
    const bool slip = Uniform(random) < config_.flip;
    const bool yes = question->Holds(situation.pairs[want]) != slip;
    said.push_back({*question, yes});
    ++outcome.questions;
    started = now_us_();
    dialogue->Hear(*question, {yes ? 1.0 : 0.0, yes ? 0.0 : 1.0, errors.rates});
    if (dialogue->Accepted()) break;
  }
  outcome.compute_us += now_us_() - started;
  outcome.posterior = dialogue->CurrentBelief().best_posterior;
  if (const auto accepted = dialogue->Accepted()) {
    const Pair& pair = situation.pairs[*accepted];
    const Instance& object = situation.objects[pair.object];
    PastSession learnt{object.category, pair.action, object.rank, "", {}};
    for (const Said& s : said) Count(learnt.answers, s.question.Holds(pair), s.yes);
    outcome.answered = learnt;
    outcome.correct = *accepted == want;
    user.history.push_back(learnt);
  }
  return outcome;
}

}  // namespace beckon::intention
