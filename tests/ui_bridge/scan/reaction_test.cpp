#include "services/ui_bridge/scan/reaction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace beckon::ui_bridge::scan {
namespace {

constexpr Utime kMs = 1000;

/// Log-normal reactions of the given median.
ReactionTimes Of(Utime median_us, double sigma, int presses, unsigned seed = 1,
                 int odd_of_a_hundred = 0) {
  ReactionTimes times;
  std::mt19937 engine(seed);
  std::lognormal_distribution<double> draw(std::log(static_cast<double>(median_us)), sigma);
  for (int i = 0; i < presses; ++i) {
    const bool odd = static_cast<int>(engine() % 100) < odd_of_a_hundred;
    times.Add(odd ? 20 * kSecond : static_cast<Utime>(draw(engine)));
    times.Chosen();
  }
  return times;
}

TEST(ReactionTimes, FindMeanAndSpread) {
  const auto estimate = Of(600 * kMs, 0.25, 60).Estimate();
  ASSERT_TRUE(estimate);
  EXPECT_EQ(estimate->presses, 60u);
  EXPECT_NEAR(static_cast<double>(estimate->mean_us), 600e3 * std::exp(0.25 * 0.25 / 2), 80e3);
  EXPECT_NEAR(static_cast<double>(estimate->spread_us), 155e3, 80e3);
}

TEST(ReactionTimes, AreNotLedAstrayByOddPresses) {
  double worst = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const double mean = static_cast<double>(Of(600 * kMs, 0.2, 60, seed, 15).Estimate()->mean_us);
    worst = std::max(worst, std::abs(mean / 612e3 - 1));
  }
  EXPECT_LT(worst, 0.25);  // 15 % of 20 s would make the plain mean 3.5 s
}

TEST(ReactionTimes, SuggestAScanTimeByTheRule) {
  const auto suggestion = Of(650 * kMs, 0, 12).Suggest(2000 * kMs);
  ASSERT_TRUE(suggestion);
  EXPECT_EQ(suggestion->scan_us, 1000 * kMs);
  EXPECT_FALSE(suggestion->because_undone);
}

TEST(ReactionTimes, SuggestNothingFromFewPressesNorWhatIsAboutTheSame) {
  EXPECT_FALSE(Of(650 * kMs, 0, 11).Suggest(2000 * kMs));
  EXPECT_FALSE(Of(650 * kMs, 0, 60).Suggest(1100 * kMs));
  EXPECT_FALSE(ReactionTimes().Suggest(1000 * kMs));
  EXPECT_FALSE(ReactionTimes().Estimate());
}

TEST(ReactionTimes, SuggestASlowerScanWhereManyChoicesAreTakenBack) {
  ReactionTimes times;
  for (int i = 0; i < 20; ++i) {
    times.Add(300 * kMs);  // a late press falls on the next entry and looks quick
    times.Chosen();
    if (i % 5 == 0) times.Undone();
  }
  const auto suggestion = times.Suggest(1000 * kMs);
  ASSERT_TRUE(suggestion);
  EXPECT_TRUE(suggestion->because_undone);
  EXPECT_EQ(suggestion->scan_us, 1250 * kMs);
  times.ScanTimeChanged();
  EXPECT_FALSE(times.Suggest(1250 * kMs)->because_undone);
}

TEST(ReactionTimes, AskOnceAndAgainOnlyAfterAsManyPresses) {
  ReactionTimes times = Of(650 * kMs, 0, 30);
  ASSERT_TRUE(times.Suggest(2000 * kMs));
  times.Asked();
  EXPECT_FALSE(times.Suggest(2000 * kMs));
  for (int i = 0; i < 12; ++i) times.Add(650 * kMs);
  EXPECT_TRUE(times.Suggest(2000 * kMs));
}

TEST(ReactionTimes, StayWithinReasonForAnyPresses) {
  std::mt19937 engine(3);
  for (int round = 0; round < 2000; ++round) {
    ReactionTimes times;
    for (int i = 0; i < 40; ++i) {
      times.Add(static_cast<Utime>(engine()) - (1 << 20) + (static_cast<Utime>(engine()) << 20));
      if (engine() % 2 == 0) times.Chosen();
      if (engine() % 3 == 0) times.Undone();
    }
    const Utime scan_us = 50 * kMs + engine() % (60 * kSecond);
    if (const auto suggestion = times.Suggest(scan_us)) {
      ASSERT_GE(suggestion->scan_us, 300 * kMs);
      ASSERT_LE(suggestion->scan_us, 15 * kSecond);
    }
  }
}

}  // namespace
}  // namespace beckon::ui_bridge::scan
