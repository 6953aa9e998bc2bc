#include "services/intention/core/lookahead.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "services/intention/core/question_families.h"

namespace beckon::intention {
namespace {

/// Followed a second step: at most so many questions, with no more answers in all than this.
constexpr size_t kFollowed = 4;
constexpr int kMostAnswers = 10;
/// Dearer ones, in questions, are not followed.
constexpr double kDearer = 0.1;
/// Dearer ones, by proportion, are taken where they are easier to understand.
constexpr double kSame = 0.002;

/// The easiest to understand first.
int Difficulty(const PricedQuestion& question) {
  switch (question.kind) {
    case QuestionKind::kFull:
      return 0;
    case QuestionKind::kObject:
      return 1;
    case QuestionKind::kAction:
      return std::has_single_bit(question.asked.actions) ? 2 : 4;
    case QuestionKind::kCategory:
      return 3;
    case QuestionKind::kSet:
      return 5;
    case QuestionKind::kChoice:
      return 6;
  }
  return 6;
}

class Lookahead {
 public:
  Lookahead(const Situation& situation, const std::vector<double>& posterior,
            const QuestionCost& cost, QueryFamilies families)
      : situation_(situation), groups_(situation), cost_(cost), families_(families) {
    for (const double p : posterior) pairs_.push_back(Mass::Of(p));
    const double none = 1 - std::accumulate(posterior.begin(), posterior.end(), 0.0);
    if (none >= 1e-12) none_ = Mass::Of(none);
  }

  std::optional<Choice> Best() {
    const CheapestQuestions near(situation_, groups_, cost_, families_, pairs_, none_, kFollowed);
    priced_ += near.priced();
    if (near.best().empty()) return std::nullopt;
    const PricedQuestion* best = nullptr;
    double cheapest = 0, chosen = 0;
    const auto followed = Worthwhile(near.best());
    if (followed.size() < 2) return Found(near.best().front(), near.best().front().cost);
    for (const PricedQuestion& candidate : followed) {
      const double cost = Follow(candidate.AsQuestion());
      const bool better = best == nullptr || (Difficulty(candidate) < Difficulty(*best)
                                                  ? cost <= cheapest * (1 + kSame)
                                                  : cost < chosen * (1 - kSame));
      cheapest = best == nullptr ? cost : std::min(cheapest, cost);
      if (!better) continue;
      best = &candidate;
      chosen = cost;
    }
    return Found(*best, chosen);
  }

 private:
  Choice Found(const PricedQuestion& priced, double cost) const {
    const Question question = priced.AsQuestion();
    const double total = Sum(), after = cost - SecondsOf(question);
    return {question, 1 + after / total / cost_.seconds(), cost / total, priced_};
  }

  /// Those that a second step is looked at for.
  std::span<const PricedQuestion> Worthwhile(const std::vector<PricedQuestion>& best) const {
    const double limit = best.front().cost + kDearer * cost_.seconds() * Sum();
    size_t n = 0;
    int answers = 0;
    while (n < best.size() && best[n].cost <= limit) {
      answers += best[n].AsQuestion().answers();
      if (answers > kMostAnswers) break;
      ++n;
    }
    return std::span(best).first(n);
  }

  double Sum() const {
    double sum = none_.p;
    for (const Mass& pair : pairs_) sum += pair.p;
    return sum;
  }

  /// Weighs the candidates by an answer; returns their sum.
  double Hear(const Question& question, int said, std::vector<Mass>& pairs, Mass& none) const {
    const AnswerWeight& weight = cost_.Weigh(question.answers(), said);
    double sum = 0;
    const auto weigh = [&](const Mass& mass, bool meant) {
      const double w = meant ? weight.meant : weight.other;
      const double w_log_w = meant ? weight.meant_log_meant : weight.other_log_other;
      sum += w * mass.p;
      return Mass{w * mass.p, w * mass.p_log_p + mass.p * w_log_w};
    };
    for (size_t i = 0; i < pairs_.size(); ++i)
      pairs[i] =
          pairs_[i].p > 0 ? weigh(pairs_[i], question.Meant(situation_.pairs[i]) == said) : Mass{};
    none = weigh(none_, said == question.none());
    return sum;
  }

  /// Cost of a question where the best one is asked after it.
  double Follow(const Question& question) {
    std::vector<Mass> pairs(pairs_.size());
    Mass none;
    double cost = 0;
    for (int said = 0; said < question.answers(); ++said) {
      const double sum = Hear(question, said, pairs, none);
      if (sum <= 1e-12) continue;
      cost += sum * cost_.interface().Seconds(question.answers(), said);
      const int accepts = question.Accepts(said);
      if (accepts >= 0 &&
          cost_.Ends(cost_.Weigh(question.answers(), said), pairs_[accepts].p, Sum()))
        continue;
      const CheapestQuestions next(situation_, groups_, cost_, families_, pairs, none, 1);
      priced_ += next.priced();
      cost += next.Cost();
    }
    return cost;
  }

  /// Of the question itself.
  double SecondsOf(const Question& question) const {
    std::vector<Mass> pairs(pairs_.size());
    Mass none;
    double seconds = 0;
    for (int said = 0; said < question.answers(); ++said)
      seconds +=
          Hear(question, said, pairs, none) * cost_.interface().Seconds(question.answers(), said);
    return seconds;
  }

  const Situation& situation_;
  const ObjectGroups groups_;
  const QuestionCost& cost_;
  const QueryFamilies families_;
  std::vector<Mass> pairs_;
  Mass none_;
  int priced_ = 0;
};

}  // namespace

double RemainingQuestions(double entropy_bits, double capacity_bits) {
  const double questions = entropy_bits / capacity_bits;
  return questions + 0.05 + 0.95 * std::exp(-1.6 * questions);
}

std::optional<Choice> ChooseQuestion(const Situation& situation,
                                     const std::vector<double>& posterior,
                                     const Interface& interface, const ErrorRates& rates,
                                     QueryFamilies families, double accept_posterior) {
  const QuestionCost cost(interface, rates, accept_posterior);
  return Lookahead(situation, posterior, cost, families).Best();
}

}  // namespace beckon::intention
