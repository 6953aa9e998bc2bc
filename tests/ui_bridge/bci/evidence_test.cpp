// A trial's probabilities as evidence.
#include "services/ui_bridge/bci/evidence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace beckon::ui_bridge::bci {
namespace {

using ::testing::HasSubstr;

TEST(Evidence, AnHonestDecoderIsTakenAtItsWord) {
  const std::vector<double> p = {0.6, 0.3, 0.1};
  const auto logs = LogLikelihoods(p, {.sharpness = 1});
  EXPECT_DOUBLE_EQ(logs[0], 0);
  const auto soft = Softened(p);
  EXPECT_NEAR(logs[1], std::log(soft[1] / soft[0]), 1e-12);
  EXPECT_NEAR(logs[2], std::log(soft[2] / soft[0]), 1e-12);
  EXPECT_NEAR(std::exp(logs[1]), 0.5, 0.02);
}

TEST(Evidence, ALowerSharpnessTempersIt) {
  const std::vector<double> p = {0.7, 0.2, 0.1};
  const auto full = LogLikelihoods(p, {.sharpness = 1}),
             half = LogLikelihoods(p, {.sharpness = 0.5});
  for (size_t i = 0; i < p.size(); ++i) EXPECT_NEAR(half[i], full[i] / 2, 1e-12);
}

TEST(Evidence, ANameAloneIsReadThroughTheConfusion) {
  // Class 0 is often taken for 1, class 2 never.
  const Confusion confusion = {{0.5, 0.45, 0.05}, {0.1, 0.8, 0.1}, {0.05, 0.05, 0.9}};
  const auto logs = LogLikelihoods({0, 1, 0}, {.sharpness = 0, .habit = 1, .confusion = confusion});
  EXPECT_NEAR(std::exp(logs[0] - logs[1]), 0.45 / 0.8, 0.02);
  EXPECT_NEAR(std::exp(logs[2] - logs[1]), 0.05 / 0.8, 0.03);
}

TEST(Evidence, NothingIsImpossible) {
  const auto logs = LogLikelihoods({1, 0, 0, 0}, {.sharpness = 1});
  for (const double log : logs) EXPECT_GT(log, -5.5);
}

TEST(Evidence, KeepsTheOrderOfClassesWhenTheyAreRenamed) {
  const std::vector<double> p = {0.5, 0.25, 0.15, 0.1}, turned = {0.1, 0.5, 0.25, 0.15};
  const DecoderModel model{.sharpness = 0.8, .habit = 0.3, .confusion = EvenConfusion(4, 0.7)};
  auto logs = LogLikelihoods(p, model);
  std::rotate(logs.rbegin(), logs.rbegin() + 1, logs.rend());
  const auto of_turned = LogLikelihoods(turned, model);
  for (size_t i = 0; i < p.size(); ++i) EXPECT_NEAR(logs[i], of_turned[i], 1e-12);
}

TEST(Evidence, RefusesWhatAreNoProbabilities) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(CheckProbabilities({0.5, 0.5}, 2));
  EXPECT_THAT(CheckProbabilities({0.5, 0.5}, 3).error().message, HasSubstr("expected 3"));
  for (const auto& wrong : std::vector<std::vector<double>>{
           {nan, 1}, {-0.1, 1.1}, {0.5, 0.6}, {0, 0}, {INFINITY, 0}, {2, -1}})
    EXPECT_FALSE(CheckProbabilities(wrong, 2));
}

}  // namespace
}  // namespace beckon::ui_bridge::bci
