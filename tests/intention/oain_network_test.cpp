#include "services/intention/core/oain_network.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/intention/fixtures.h"

namespace beckon::intention {
namespace {

/// A factor by states FF TF FT TT (object, action).
using Factor = std::array<double, 4>;

/// The dissertation's learning rule, as it is written there.
Factor Learn(int times) {
  Factor f = {1.0 / 8, 1.0 / 8, 1.0 / 8, 5.0 / 8};
  for (int i = 0; i < times; ++i) {
    f[3] += 1;
    const double sum = f[0] + f[1] + f[2] + f[3];
    for (double& x : f) x /= sum;
  }
  return f;
}

/// Max-marginals by trying all states of all nodes.
struct BruteForce {
  const Situation& situation;
  std::vector<Factor> factors;
  int actions;

  double Value(uint64_t object_states, uint64_t action_states) const {
    double product = 1;
    for (size_t i = 0; i < factors.size(); ++i) {
      const bool o = object_states >> situation.pairs[i].object & 1;
      const bool a = action_states >> situation.pairs[i].action & 1;
      product *= factors[i][(o ? 1 : 0) + (a ? 2 : 0)];
    }
    return product;
  }
  template <typename Holds>
  double Marginal(Holds holds) const {
    double yes = 0, all = 0;
    double total[4] = {0, 0, 0, 0};
    for (uint64_t o = 0; o < uint64_t{1} << situation.objects.size(); ++o) {
      for (uint64_t a = 0; a < uint64_t{1} << actions; ++a) {
        const int state = holds(o, a);
        total[state] = std::max(total[state], Value(o, a));
      }
    }
    yes = total[0];
    all = total[0] + total[1] + total[2] + total[3];
    return yes / all;
  }
};

TEST(OainNetwork, RatioFollowsTheLearningRule) {
  for (int n = 0; n < 12; ++n) {
    const Factor f = Learn(n);
    EXPECT_NEAR(std::exp(OainNetwork::LogRatio(n)) / (f[3] / f[0]), 1, 1e-12) << n;
    EXPECT_NEAR(f[3] / f[0], 8 * std::exp2(n) - 3, 1e-9 * f[3] / f[0]);
  }
  EXPECT_TRUE(std::isfinite(OainNetwork::LogRatio(100'000)));
}

TEST(OainNetwork, ClosedFormEqualsBruteForce) {
  const Affordances affordances = TestAffordances();
  std::mt19937_64 random(3);
  const int actions = static_cast<int>(affordances.actions().size());
  for (int trial = 0; trial < 20; ++trial) {
    const Situation situation =
        MakeSituation(affordances, RandomThings(affordances, random, 5, false));
    UserHistory history;
    std::vector<Factor> factors;
    for (const Pair& pair : situation.pairs) {
      const int category = situation.objects[pair.object].category;
      int known = 0;
      for (const auto& past : history)
        known += past.category == category && past.action == pair.action;
      if (known == 0) {
        known = static_cast<int>(random() % 4);
        for (int i = 0; i < known; ++i) history.push_back({category, pair.action, 1, {}, 0, {}});
      }
    }
    for (const Pair& pair : situation.pairs) {
      int known = 0;
      for (const auto& past : history) {
        known +=
            past.category == situation.objects[pair.object].category && past.action == pair.action;
      }
      factors.push_back(Learn(known));
    }
    const OainNetwork network(affordances, situation, history);
    const BruteForce brute{situation, factors, actions};
    for (int i = 0; i < situation.pair_count(); ++i) {
      const Pair pair = situation.pairs[i];
      EXPECT_NEAR(network.Action(pair.action), brute.Marginal([&](uint64_t, uint64_t a) {
        return a >> pair.action & 1 ? 0 : 1;
      }),
                  1e-12);
      EXPECT_NEAR(network.Object(pair.object), brute.Marginal([&](uint64_t o, uint64_t) {
        return o >> pair.object & 1 ? 0 : 1;
      }),
                  1e-12);
      EXPECT_NEAR(network.Full(i), brute.Marginal([&](uint64_t o, uint64_t a) {
        return (o >> pair.object & 1 ? 0 : 1) + (a >> pair.action & 1 ? 0 : 2);
      }),
                  1e-12);
    }
  }
}

}  // namespace
}  // namespace beckon::intention
