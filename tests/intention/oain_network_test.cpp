#include "services/intention/core/oain_network.h"

#include <algorithm>
#include <cmath>

#include "tests/intention/fixtures.h"

namespace beckon::intention {
namespace {

/// The dissertation's learning rule, as it is written there.
PairTable Learn(int times, double lambda) {
  PairTable f = {1.0 / 8, 1.0 / 8, 1.0 / 8, 5.0 / 8};
  for (int i = 0; i < times; ++i) {
    f[3] += lambda;
    const double sum = f[0] + f[1] + f[2] + f[3];
    for (double& x : f) x /= sum;
  }
  return f;
}

LearntPairs RandomLearning(const Affordances& affordances, std::mt19937_64& random, int most) {
  LearntPairs learnt;
  for (size_t category = 0; category < affordances.categories().size(); ++category) {
    for (const int action : affordances.categories()[category].actions) {
      if (random() % 3 == 0) {
        learnt[{static_cast<int>(category), action}] =
            static_cast<int>(random() % static_cast<uint64_t>(most));
      }
    }
  }
  return learnt;
}

void ExpectNear(const OainMarginals& a, const OainMarginals& b, double tolerance) {
  ASSERT_EQ(a.actions.size(), b.actions.size());
  ASSERT_EQ(a.objects.size(), b.objects.size());
  ASSERT_EQ(a.pairs.size(), b.pairs.size());
  for (size_t i = 0; i < a.actions.size(); ++i) EXPECT_NEAR(a.actions[i], b.actions[i], tolerance);
  for (size_t i = 0; i < a.objects.size(); ++i) EXPECT_NEAR(a.objects[i], b.objects[i], tolerance);
  for (size_t i = 0; i < a.pairs.size(); ++i) EXPECT_NEAR(a.pairs[i], b.pairs[i], tolerance);
}

TEST(OainNetwork, FactorsFollowTheLearningRule) {
  for (const double lambda : {0.1, 0.5, 1.0, 5.0}) {
    for (int n = 0; n < 12; ++n) {
      const PairTable f = Learn(n, lambda);
      const PairTable log_f = OainNetwork::LogFactor(n, lambda);
      for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(std::exp(log_f[i]) / f[i], 1, 1e-12) << n;
      EXPECT_NEAR(f[3] / f[0] / (8 * std::pow(1 + lambda, n) - 3), 1, 1e-12);
    }
  }
  for (const double log : OainNetwork::LogFactor(100'000, 5)) EXPECT_TRUE(std::isfinite(log));
}

TEST(OainNetwork, InferenceEqualsTheClosedForm) {
  const Affordances affordances = TestAffordances();
  std::mt19937_64 random(3);
  for (const double lambda : {0.1, 1.0, 5.0}) {
    for (int trial = 0; trial < 40; ++trial) {
      const Situation situation =
          MakeSituation(affordances, RandomThings(affordances, random, 20, false));
      const OainNetwork network(affordances, situation, RandomLearning(affordances, random, 30),
                                lambda);
      ExpectNear(network.MaxMarginals(), network.ClosedForm(), 1e-12);
    }
  }
}

TEST(OainNetwork, DistanceSaysNothingOfWhatIsWanted) {
  for (const double distance_m : {0.0, 0.2, 0.41, 0.43, 0.8}) {
    const PairTable log_f = OainNetwork::LogDistanceFactor(distance_m, 0.8);
    EXPECT_EQ(std::max(log_f[0], log_f[2]), std::max(log_f[1], log_f[3])) << distance_m;
  }
  // Near is up to half the largest distance and 2 cm; then the object goes with "near".
  EXPECT_NEAR(std::exp(OainNetwork::LogDistanceFactor(0.41, 0.8)[3]), 1 - 0.41 / 0.8, 1e-15);
  EXPECT_NEAR(std::exp(OainNetwork::LogDistanceFactor(0.43, 0.8)[3]), 0.43 / 0.8, 1e-15);

  const Affordances a = TestAffordances();
  const LearntPairs learnt = {{{a.FindCategory("Mug"), a.FindAction("Drink")}, 3}};
  const Situation near =
      MakeSituation(a, Things(a, {{"Mug", 0.2}, {"Tube", 0.9}, {"Mug", 0.3}, {"Box", 0.5}}));
  const Situation far =
      MakeSituation(a, Things(a, {{"Mug", 0.9}, {"Tube", 0.1}, {"Mug", 0.95}, {"Box", 0.0}}));
  ExpectNear(OainNetwork(a, near, learnt).MaxMarginals(),
             OainNetwork(a, far, learnt).MaxMarginals(), 1e-14);
}

TEST(OainNetwork, LikesWhatWasLearnt) {
  const Affordances a = TestAffordances();
  const Situation s = MakeSituation(a, Things(a, {{"Box", 0.5}, {"Carton", 0.6}, {"Mug", 0.7}}));
  const int open = a.FindAction("Open"), box = a.FindCategory("Box");
  const auto before = OainNetwork(a, s, {}).MaxMarginals();
  const auto after = OainNetwork(a, s, {{{box, open}, 2}}).MaxMarginals();
  const int pair = s.Find(box, 1, open);
  EXPECT_GT(after.pairs[pair], before.pairs[pair]);
  EXPECT_GT(after.actions[open], before.actions[open]);
  EXPECT_EQ(std::max_element(after.pairs.begin(), after.pairs.end()) - after.pairs.begin(), pair);
}

TEST(OainNetwork, StaysExactBeyondWhatCanBeEnumerated) {
  // 20 categories with 20 actions each: too many of both, so that the closed form answers.
  std::vector<Action> actions;
  std::vector<Affordances::Entry> entries;
  std::vector<std::string> names;
  for (char c = 'a'; c < 'a' + 20; ++c) {
    actions.push_back({std::string("act ") + c, std::string("act ") + c});
    names.push_back(actions.back().name);
  }
  for (char c = 'a'; c < 'a' + 20; ++c) entries.push_back({std::string("Thing ") + c, names});
  const auto affordances = Affordances::Make(actions, entries);
  ASSERT_TRUE(affordances.ok());
  std::vector<Thing> things;
  for (int i = 0; i < 20; ++i) things.push_back({i, 0.5 + 0.01 * i, 0});
  const Situation situation = MakeSituation(*affordances, things);
  const OainNetwork network(*affordances, situation, {{{3, 4}, 1}});
  const OainMarginals found = network.MaxMarginals();
  EXPECT_EQ(std::max_element(found.pairs.begin(), found.pairs.end()) - found.pairs.begin(),
            situation.Find(3, 1, 4));
  ExpectNear(found, network.ClosedForm(), 0);
}

TEST(CountPairs, CountsByCategoryAndAction) {
  PastSession drink_mug, grasp_mug;
  drink_mug.category = grasp_mug.category = 6;
  grasp_mug.action = 1;
  grasp_mug.rank = 2;
  EXPECT_EQ(CountPairs({drink_mug, grasp_mug, drink_mug}), (LearntPairs{{{6, 0}, 2}, {{6, 1}, 1}}));
}

}  // namespace
}  // namespace beckon::intention
