#include "services/intention/core/evaluation.h"

#include <algorithm>
#include <random>

#include "services/intention/core/answer_errors.h"
#include "services/intention/core/simulated_decoder.h"

namespace beckon::intention {
namespace {

/// Uniform in [0, 1), the same on every platform.
double Uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1.0p-53; }

/// What is heard of a user who wants `wanted`, a likelihood an answer: a press, slips included, or
/// what a decoder makes of it.
std::vector<double> Answer(const Question& question, const Pair& wanted, InterfaceKind kind,
                           double flip, std::mt19937_64& random) {
  const int meant = question.Meant(wanted);
  if (kind == InterfaceKind::kVector)
    return DecodedLikelihoods(question.answers(), meant, flip, random);
  std::vector<double> heard(static_cast<size_t>(question.answers()), 0.0);
  const int others = question.answers() - 1;
  int said = meant;
  if (Uniform(random) < flip) {
    const int slip = others == 1 ? 0 : static_cast<int>(random() % static_cast<uint64_t>(others));
    said = slip < meant ? slip : slip + 1;
  }
  heard[static_cast<size_t>(said)] = 1;
  return heard;
}

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

Interface Evaluation::InterfaceOf(const User& user) const {
  Interface interface = config_.interface;
  if (config_.assume_flip) {
    interface.errors = ErrorModel::Exact({*config_.assume_flip, *config_.assume_flip});
  } else if (config_.flip > 0) {
    interface.errors = ErrorModel::Unknown().Learnt(PastAnswers(user.history, ""));
  } else {
    interface.errors = ErrorModel::Exact({});
  }
  return interface;
}

SessionOutcome Evaluation::Live(const ScenarioSession& session, SessionWatcher* watcher) {
  User& user = Find(session.user);
  const uint64_t seed = config_.seed * 1'000'003 + sessions_++;
  std::mt19937_64 random(seed);
  const Situation situation = MakeSituation(affordances_, session.scene, session.utime);
  const int want = situation.Find(session.want_category, session.want_rank, session.want_action);

  SessionOutcome outcome;
  struct Said {
    Question question;
    int answer;
  };
  std::vector<Said> said;
  double started = now_us_();
  const Interface interface = InterfaceOf(user);
  const auto dialogue = policy_.Begin(situation, user.history, interface, seed);
  outcome.compute_us += now_us_() - started;
  const SessionView view{session, situation, user.history, interface, want};
  if (watcher != nullptr) watcher->Begun(view, dialogue->CurrentBelief());
  started = now_us_();
  while (outcome.questions < config_.most_questions) {
    const auto question = dialogue->Ask();
    outcome.compute_us += now_us_() - started;
    started = now_us_();
    if (!question) break;
    const auto heard =
        Answer(*question, situation.pairs[want], interface.kind, config_.flip, random);
    const int answer = SaidAnswer(heard);
    said.push_back({*question, answer});
    ++outcome.questions;
    outcome.seconds += interface.Seconds(question->answers(), answer);
    const Belief before = watcher != nullptr ? dialogue->CurrentBelief() : Belief();
    started = now_us_();
    dialogue->Hear(*question, interface.errors.Hear(heard));
    outcome.compute_us += now_us_() - started;
    if (watcher != nullptr)
      watcher->Answered(view, {*question, before, answer, dialogue->CurrentBelief()});
    started = now_us_();
    if (dialogue->Accepted()) break;
  }
  outcome.compute_us += now_us_() - started;
  outcome.posterior = dialogue->CurrentBelief().best_posterior;
  if (const auto accepted = dialogue->Accepted()) {
    const Pair& pair = situation.pairs[*accepted];
    const Instance& object = situation.objects[pair.object];
    PastSession learnt;
    learnt.category = object.category;
    learnt.action = pair.action;
    learnt.rank = object.rank;
    learnt.utime = session.utime;
    learnt.present = situation.Present(affordances_);
    for (const Said& s : said)
      Count(learnt.answers[""], s.question.answers(), s.question.Meant(pair), s.answer);
    outcome.answered = learnt;
    outcome.correct = *accepted == want;
  }
  if (watcher != nullptr) watcher->Ended(view, outcome);
  if (outcome.answered) user.history.push_back(*outcome.answered);
  return outcome;
}

}  // namespace beckon::intention
