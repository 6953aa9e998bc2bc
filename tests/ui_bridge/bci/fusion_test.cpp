// Several trials of one question.
#include "services/ui_bridge/bci/fusion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "services/ui_bridge/bci/evidence.h"

namespace beckon::ui_bridge::bci {
namespace {

const std::vector<double> kLogs = {0, -1, -2};

TEST(Fusion, NothingHeardLeavesThePrior) {
  const Fusion fusion(3);
  const auto posterior = fusion.Posterior({0.2, 0.5, 0.3});
  EXPECT_NEAR(posterior[0], 0.2, 1e-12);
  EXPECT_NEAR(posterior[1], 0.5, 1e-12);
  EXPECT_NEAR(posterior[2], 0.3, 1e-12);
}

TEST(Fusion, EqualTrialsMultiply) {
  Fusion fusion(3);
  for (int i = 0; i < 5; ++i) fusion.Add(kLogs);
  const auto likelihoods = fusion.Likelihoods(3);
  EXPECT_EQ(fusion.trials(), 5);
  EXPECT_NEAR(likelihoods[1] / likelihoods[0], std::exp(-5), 1e-12);
  EXPECT_NEAR(likelihoods[2] / likelihoods[0], std::exp(-10), 1e-12);
}

TEST(Fusion, TheOrderOfTrialsDoesNotMatter) {
  Fusion one(3), other(3);
  one.Add(kLogs);
  one.Add({-3, 0, -1});
  other.Add({-3, 0, -1});
  other.Add(kLogs);
  EXPECT_EQ(one.Likelihoods(3), other.Likelihoods(3));
}

TEST(Fusion, APriorIsNoPartOfTheLikelihoods) {
  Fusion fusion(3);
  fusion.Add(kLogs);
  const auto even = fusion.Posterior({1, 1, 1});
  const auto likelihoods = fusion.Likelihoods(3);
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(likelihoods[i], even[i], 1e-12);
  const auto skewed = fusion.Posterior({0.01, 0.01, 0.98});
  EXPECT_GT(skewed[2], 0.9);
  EXPECT_EQ(fusion.Likelihoods(3), likelihoods);
}

TEST(Fusion, WhatIsNotOnOfferTakesNoShare) {
  Fusion fusion(3);
  fusion.Add(kLogs);
  EXPECT_EQ(fusion.Posterior({0, 0.5, 0.5})[0], 0);
  const auto two = fusion.Likelihoods(2);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_NEAR(two[0] + two[1], 1, 1e-12);
  EXPECT_NEAR(two[1] / two[0], std::exp(-1), 1e-12);
}

TEST(Fusion, ThousandsOfTrialsStayFinite) {
  Fusion fusion(3);
  for (int i = 0; i < 100'000; ++i) fusion.Add({0, -5, -700});
  for (const double p : fusion.Posterior({1, 1, 1})) EXPECT_TRUE(std::isfinite(p));
  EXPECT_EQ(fusion.Likelihoods(3)[0], 1);
}

}  // namespace
}  // namespace beckon::ui_bridge::bci
