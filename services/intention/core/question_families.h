// The questions that can be asked, priced one step ahead.
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "services/intention/core/policy.h"
#include "services/intention/core/question_cost.h"

namespace beckon::intention {

/// What of a situation does not change with the answers: its groups of objects, as masks.
struct ObjectGroups {
  std::vector<uint64_t> categories;  // every known one
  std::vector<uint64_t> prefixes;    // the k nearest, the k furthest to the left, 1 < k < all

  explicit ObjectGroups(const Situation& situation);
};

/// A question and what it costs: weighed by the probability of the candidates.
struct PricedQuestion {
  double cost = 0;
  QuestionKind kind = QuestionKind::kFull;
  Proposition asked;                 // of a yes/no question
  std::vector<Proposition> options;  // of a choice

  Question AsQuestion() const;
};

/// The cheapest questions about a distribution, which need not sum to 1.
class CheapestQuestions {
 public:
  /// `pairs`: by pair; `none`: that none of them is wanted. All arguments must outlive this.
  CheapestQuestions(const Situation& situation, const ObjectGroups& groups,
                    const QuestionCost& cost, QueryFamilies families, std::span<const Mass> pairs,
                    const Mass& none, size_t keep);

  /// The cheapest first, at most `keep`; of those that cost the same only the easiest. Empty where
  /// no pair has any probability.
  const std::vector<PricedQuestion>& best() const { return best_; }
  /// Cost of the cheapest; that of confirming where there is none.
  double Cost() const;
  int priced() const { return priced_; }

 private:
  /// Of the pairs that a proposition holds for.
  struct Part {
    Mass mass;
    int possible = 0;    // pairs with any probability
    int likeliest = -1;  // pair
    void Add(const Mass& pair_mass, int pair, std::span<const Mass> pairs);
    void Add(const Part& part, std::span<const Mass> pairs);
  };
  /// An option of a choice.
  using Offered = std::pair<Part, Proposition>;

  void Offer(double cost, QuestionKind kind, const Proposition& asked,
             std::span<const Offered> options = {});
  void Consider(QuestionKind kind, uint64_t actions, uint64_t objects, const Part& part);
  void ConsiderFull();
  void ConsiderPairsOfActions();
  void ConsiderChoices(QueryFamilies families);
  void ConsiderChoiceOf(std::vector<Offered> options);
  Part PartOf(uint64_t objects) const;
  Proposition AskedBy(const Part& part, const Proposition& proposition) const;
  int object_count() const { return static_cast<int>(situation_.objects.size()); }

  const Situation& situation_;
  const ObjectGroups& groups_;
  const QuestionCost& cost_;
  const std::span<const Mass> pairs_;
  const size_t keep_;
  Mass total_;
  std::array<Part, kMaxActions> by_action_;
  std::array<Part, kMaxThings> by_object_;
  std::vector<PricedQuestion> best_;
  int priced_ = 0;
};

}  // namespace beckon::intention
