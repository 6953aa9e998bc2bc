// What the relay does to frames, without any network.
#include "tests/faults/link_faults.h"

#include <gtest/gtest.h>

#include <set>

namespace beckon::faults {
namespace {

constexpr int kFrames = 20'000;

TEST(LinkFaultsTest, AGoodNetworkDeliversEachFrameOnceAndAtOnce) {
  LinkFaults faults(3, 1);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(faults.Deliveries(0, 2), std::vector<Utime>{0});
}

TEST(LinkFaultsTest, LosesAndDoublesAsOftenAsTold) {
  LinkFaults faults(2, 1, {.loss = 0.01, .duplicate = 0.05});
  int lost = 0, doubled = 0;
  for (int i = 0; i < kFrames; ++i) {
    const size_t copies = faults.Deliveries(0, 1).size();
    lost += copies == 0 ? 1 : 0;
    doubled += copies == 2 ? 1 : 0;
  }
  EXPECT_NEAR(lost, 0.01 * kFrames, 60);
  EXPECT_NEAR(doubled, 0.05 * kFrames, 150);
}

TEST(LinkFaultsTest, HoldsBackAtMostAsLongAsTold) {
  LinkFaults faults(2, 1, {.reorder = 0.5, .held_back_us = 1000, .delay_us = 300});
  std::set<Utime> delays;
  for (int i = 0; i < kFrames; ++i) {
    for (const Utime delay : faults.Deliveries(0, 1)) delays.insert(delay);
  }
  EXPECT_EQ(*delays.begin(), 300);
  EXPECT_EQ(*delays.rbegin(), 1300);
}

TEST(LinkFaultsTest, NothingCrossesACutUntilItHeals) {
  LinkFaults faults(3, 1);
  faults.Cut({0, 1, 0});
  EXPECT_TRUE(faults.Deliveries(0, 1).empty());
  EXPECT_TRUE(faults.Deliveries(1, 2).empty());
  EXPECT_EQ(faults.Deliveries(2, 0).size(), 1u);
  faults.Heal();
  EXPECT_EQ(faults.Deliveries(0, 1).size(), 1u);
}

TEST(LinkFaultsTest, ACutAtRandomAlwaysCuts) {
  LinkFaults faults(3, 7);
  for (int i = 0; i < 100; ++i) {
    faults.CutAtRandom();
    EXPECT_FALSE(faults.Connected(0, 1) && faults.Connected(1, 2));
  }
}

TEST(LinkFaultsTest, TheSeedDecidesEverything) {
  const FaultRates rates{.loss = 0.2, .duplicate = 0.2, .reorder = 0.2};
  LinkFaults one(3, 5, rates), same(3, 5, rates), other(3, 6, rates);
  int differences = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto deliveries = one.Deliveries(0, 1);
    EXPECT_EQ(deliveries, same.Deliveries(0, 1));
    differences += deliveries == other.Deliveries(0, 1) ? 0 : 1;
  }
  EXPECT_GT(differences, 100);
}

}  // namespace
}  // namespace beckon::faults
