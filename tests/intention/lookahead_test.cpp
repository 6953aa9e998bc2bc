#include "services/intention/core/lookahead.h"

#include <cmath>
#include <numeric>

#include "tests/intention/fixtures.h"

namespace beckon::intention {
namespace {

double Entropy(const std::vector<double>& p) {
  const double sum = std::accumulate(p.begin(), p.end(), 0.0);
  double h = 0;
  for (const double x : p) {
    if (x > 0) h -= x / sum * std::log2(x / sum);
  }
  return h;
}

/// Cost of a question with each posterior computed by itself.
double BruteCost(const Situation& s, const std::vector<double>& p, const Question& q,
                 const ErrorRates& r, double accept) {
  std::vector<double> yes(p), no(p);
  for (int i = 0; i < s.pair_count(); ++i) {
    yes[i] *= q.Meant(s.pairs[i]) == 0 ? 1 - r.false_no : r.false_yes;
    no[i] *= q.Meant(s.pairs[i]) == 0 ? r.false_no : 1 - r.false_yes;
  }
  const double p_yes = std::accumulate(yes.begin(), yes.end(), 0.0);
  const double p_no = std::accumulate(no.begin(), no.end(), 0.0);
  const double capacity = Capacity(r);
  double cost = 1;
  const bool ends = q.kind == QuestionKind::kFull && yes[q.Accepts(0)] >= accept * p_yes;
  if (!ends && p_yes > 0) cost += p_yes * RemainingQuestions(Entropy(yes), capacity);
  if (p_no > 0) cost += p_no * RemainingQuestions(Entropy(no), capacity);
  return cost;
}

class LookaheadAgainstBruteForce : public testing::TestWithParam<double> {};

TEST_P(LookaheadAgainstBruteForce, FindsTheCheapestQuestion) {
  const ErrorRates rates{GetParam(), GetParam() / 2};
  const Affordances affordances = TestAffordances();
  std::mt19937_64 random(11);
  for (int trial = 0; trial < 50; ++trial) {
    const Situation s = MakeSituation(affordances, RandomThings(affordances, random, 8, true));
    std::vector<double> p(s.pairs.size());
    for (double& x : p) x = 1e-3 + std::pow(static_cast<double>(random() % 1000) / 1000, 6);
    const double sum = std::accumulate(p.begin(), p.end(), 0.0);
    for (double& x : p) x /= sum;
    const auto choice = ChooseQuestion(s, p, rates, QueryFamilies::kActionObjectFull, 0.99);
    ASSERT_TRUE(choice);
    double best = 1e9;
    for (int i = 0; i < s.pair_count(); ++i) {
      best = std::min(best, BruteCost(s, p, AskPair(s, i), rates, 0.99));
    }
    for (int a = 0; a < 7; ++a) best = std::min(best, BruteCost(s, p, AskAction(a), rates, 0.99));
    for (int o = 0; o < static_cast<int>(s.objects.size()); ++o) {
      best = std::min(best, BruteCost(s, p, AskObject(o), rates, 0.99));
    }
    EXPECT_NEAR(choice->expected_questions, best, 1e-9);
    EXPECT_NEAR(choice->expected_questions, BruteCost(s, p, choice->question, rates, 0.99), 1e-9);
    const auto more = ChooseQuestion(s, p, rates, QueryFamilies::kAll, 0.99);
    EXPECT_LE(more->expected_questions, choice->expected_questions + 1e-12);
    EXPECT_NEAR(more->expected_questions, BruteCost(s, p, more->question, rates, 0.99), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Rates, LookaheadAgainstBruteForce, testing::Values(0.0, 0.05, 0.2));

/// Cost of the best tree of full queries over n equally likely pairs where any subset may be asked
/// about: the "1-ended" code, by dynamic programming.
double BestUniformTree(int n) {
  std::vector<double> cost(n + 1, 0.0);  // total answers over the n pairs
  for (int m = 1; m <= n; ++m) {
    cost[m] = m + cost[m - 1];  // ask one fully
    for (int k = 1; k < m; ++k) cost[m] = std::min(cost[m], m + cost[k] + cost[m - k]);
  }
  return cost[n] / n;
}

TEST(RemainingQuestions, ApproximatesTheBestCode) {
  EXPECT_DOUBLE_EQ(RemainingQuestions(0, 1), 1);
  EXPECT_NEAR(BestUniformTree(43), 5.88, 0.01);
  EXPECT_NEAR(BestUniformTree(5), 2.80, 0.01);
  for (const int n : {1, 2, 3, 5, 8, 16, 43, 63}) {
    EXPECT_NEAR(RemainingQuestions(std::log2(n), 1), BestUniformTree(n), 0.06) << n;
  }
}

TEST(ChooseQuestion, AsksNothingWhereNothingIsLeft) {
  const Affordances affordances = TestAffordances();
  const Situation s = MakeSituation(affordances, Things(affordances, {{"Tube", 1}}));
  EXPECT_FALSE(ChooseQuestion(s, {0, 0}, {}, QueryFamilies::kAll, 0.99));
  const auto sure = ChooseQuestion(s, {0, 1}, {}, QueryFamilies::kAll, 0.99);
  ASSERT_TRUE(sure);
  EXPECT_EQ(sure->question, AskPair(s, 1));
  EXPECT_DOUBLE_EQ(sure->expected_questions, 1);
}

TEST(Capacity, IsABitWithoutErrors) {
  EXPECT_DOUBLE_EQ(Capacity({0, 0}), 1);
  EXPECT_NEAR(Capacity({0.05, 0.05}), 0.7136, 1e-4);
  EXPECT_GT(Capacity({0.5, 0.5}), 0);
}

}  // namespace
}  // namespace beckon::intention
