// A decoder without a brain.
#include "services/ui_bridge/bci/simulated_decoding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace beckon::ui_bridge::bci {
namespace {

class SimulatedDecodingTest : public ::testing::TestWithParam<std::pair<size_t, double>> {};

TEST_P(SimulatedDecodingTest, IsRightAsOftenAsToldAndHonest) {
  const auto [classes, accuracy] = GetParam();
  const SimulatedDecoding decoder(classes, accuracy);
  std::mt19937_64 random(1);
  constexpr int kTrials = 20'000;
  int right = 0;
  double claimed = 0;
  for (int i = 0; i < kTrials; ++i) {
    const size_t meant = static_cast<size_t>(i) % classes;
    const auto p = decoder.Draw(meant, random);
    ASSERT_EQ(p.size(), classes);
    ASSERT_NEAR(std::accumulate(p.begin(), p.end(), 0.0), 1, 1e-9);
    const auto best = std::max_element(p.begin(), p.end());
    right += static_cast<size_t>(best - p.begin()) == meant;
    claimed += *best;
  }
  const double noise = 4 * std::sqrt(accuracy * (1 - accuracy) / kTrials);
  EXPECT_NEAR(static_cast<double>(right) / kTrials, accuracy, noise);
  EXPECT_NEAR(claimed / kTrials, accuracy, noise + 0.005);
}

INSTANTIATE_TEST_SUITE_P(All, SimulatedDecodingTest,
                         ::testing::Values(std::pair<size_t, double>{2, 0.7},
                                           std::pair<size_t, double>{4, 0.7},
                                           std::pair<size_t, double>{9, 0.6},
                                           std::pair<size_t, double>{36, 0.9}));

TEST(SimulatedDecoding, AttendsToNothingEvenly) {
  const SimulatedDecoding decoder(4, 0.8);
  std::mt19937_64 random(2);
  std::vector<double> mean(4, 0.0);
  for (int i = 0; i < 8000; ++i) {
    const auto p = decoder.Draw(std::nullopt, random);
    for (size_t c = 0; c < 4; ++c) mean[c] += p[c] / 8000;
  }
  for (const double m : mean) EXPECT_NEAR(m, 0.25, 0.02);
}

TEST(SimulatedDecoding, TheSameSeedGivesTheSame) {
  const SimulatedDecoding decoder(4, 0.8);
  std::mt19937_64 one(5), other(5);
  EXPECT_EQ(decoder.Draw(2, one), decoder.Draw(2, other));
}

}  // namespace
}  // namespace beckon::ui_bridge::bci
