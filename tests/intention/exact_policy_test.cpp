#include "services/intention/core/exact_policy.h"

#include <bit>
#include <cmath>
#include <map>
#include <numeric>

#include "tests/intention/fixtures.h"

namespace beckon::intention {
namespace {

/// Cost of the best tree of questions about any set whatever, by trying all of them.
double BruteCode(const std::vector<double>& p, uint32_t set, std::map<uint32_t, double>& known) {
  if (set == 0) return 0;
  if (const auto found = known.find(set); found != known.end()) return found->second;
  double mass = 0, best = 1e9;
  for (uint32_t rest = set; rest != 0; rest &= rest - 1) {
    mass += p[std::countr_zero(rest)];
    best = std::min(best, BruteCode(p, set & ~(rest & (~rest + 1)), known));  // asked fully
  }
  for (uint32_t in = (set - 1) & set; in != 0; in = (in - 1) & set)
    best = std::min(best, BruteCode(p, in, known) + BruteCode(p, set & ~in, known));
  return known[set] = mass + best;
}

TEST(BestCode, IsTheKnownOneForEqualProbabilities) {
  const auto uniform = [](int n) { return BestCode(std::vector<double>(n, 1.0 / n)); };
  EXPECT_DOUBLE_EQ(uniform(1), 1);
  EXPECT_DOUBLE_EQ(uniform(2), 1.5);
  EXPECT_NEAR(uniform(5), 2.80, 1e-9);
  EXPECT_NEAR(uniform(43), 5.88, 0.005);
  EXPECT_EQ(BestCode({}), 0);
}

TEST(BestCode, IsTheBestOfAllTrees) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<double> p(1 + random() % 7);
    for (double& x : p) x = std::pow(0.01 + static_cast<double>(random() % 1000) / 1000, 4);
    std::map<uint32_t, double> known;
    EXPECT_NEAR(BestCode(p), BruteCode(p, (1u << p.size()) - 1, known), 1e-9);
  }
}

class ExactPolicy : public testing::Test {
 protected:
  const Affordances a = TestAffordances();
  const Situation s = MakeSituation(a, Things(a, {{"Mug", 0.3}, {"Mug", 0.6}, {"Tub", 0.5}}));
  const std::vector<double> p = {0.3, 0.05, 0.05, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1};
};

TEST_F(ExactPolicy, IsBoundedByTheBestCodeAndByFewerFamilies) {
  const Interface yes_no = Interface::YesNo();
  const double all = BestSeconds(s, p, yes_no, QueryFamilies::kAll);
  EXPECT_GE(all, BestCode(p) - 1e-12);
  EXPECT_LE(all, BestSeconds(s, p, yes_no, QueryFamilies::kActionObjectFull) + 1e-12);
}

TEST_F(ExactPolicy, OneChoiceOfAllPairsIsEnoughWhereOptionsAreFree) {
  Interface interface = Interface::YesNo();
  interface.kind = InterfaceKind::kChoice;
  interface.max_options = 10;
  EXPECT_NEAR(BestSeconds(s, p, interface, QueryFamilies::kAll), 1, 1e-12);
  interface.max_options = 2;
  EXPECT_DOUBLE_EQ(BestSeconds(s, p, interface, QueryFamilies::kAll),
                   BestSeconds(s, p, Interface::YesNo(), QueryFamilies::kAll));
}

TEST_F(ExactPolicy, AScanTakesAsLongAsItsOptionsAreAway) {
  Interface interface = Interface::YesNo();
  interface.kind = InterfaceKind::kScan;
  interface.max_options = 10;
  interface.seconds_per_question = 0.001;
  interface.seconds_per_option = 1;
  // One scan over all pairs, the likeliest first; nothing beats it.
  std::vector<double> sorted(p);
  std::sort(sorted.rbegin(), sorted.rend());
  double seconds = 0.001;
  for (size_t i = 0; i < p.size(); ++i) seconds += sorted[i] * static_cast<double>(i + 1);
  EXPECT_LE(BestSeconds(s, p, interface, QueryFamilies::kActionObjectFull), seconds + 1e-9);
}

TEST_F(ExactPolicy, CostIsThatOfThePolicysTree) {
  const Interface yes_no = Interface::YesNo();
  const auto cost = CostOf(s, p, yes_no, [&](const std::vector<double>& posterior) {
    int likeliest = 0;
    for (size_t i = 0; i < posterior.size(); ++i) {
      if (posterior[i] > posterior[likeliest]) likeliest = static_cast<int>(i);
    }
    return std::optional(AskPair(s, likeliest));
  });
  std::vector<double> sorted(p);
  std::sort(sorted.rbegin(), sorted.rend());
  double expected = 0;
  for (size_t i = 0; i < p.size(); ++i) expected += sorted[i] * static_cast<double>(i + 1);
  EXPECT_NEAR(cost.questions, expected, 1e-9);
  EXPECT_NEAR(cost.seconds, expected, 1e-9);
  EXPECT_EQ(cost.asked, 9);
}

TEST_F(ExactPolicy, GivingUpCostsInfinitelyMuch) {
  const auto cost = CostOf(s, p, Interface::YesNo(),
                           [](const std::vector<double>&) { return std::optional<Question>(); });
  EXPECT_TRUE(std::isinf(cost.questions));
}

}  // namespace
}  // namespace beckon::intention
