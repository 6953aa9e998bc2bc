#include "services/ui_bridge/scan/contact.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace beckon::ui_bridge::scan {
namespace {

constexpr Utime kMs = 1000;

std::vector<Contact::Change> Play(Contact& contact,
                                  const std::vector<std::pair<Utime, bool>>& edges, Utime end) {
  std::vector<Contact::Change> changes;
  const auto settle_until = [&](Utime time) {
    while (const auto due = contact.NextDeadline()) {
      if (*due > time) break;
      if (const auto change = contact.Settle(*due)) changes.push_back(*change);
    }
  };
  for (const auto& [at, down] : edges) {
    settle_until(at);
    contact.OnEdge(at, down);
  }
  settle_until(end);
  return changes;
}

TEST(Contact, MakesOnePressOfABouncingOneAndStampsItsBeginning) {
  Contact contact(5 * kMs);
  const auto changes = Play(contact,
                            {{0, true},
                             {1 * kMs, false},
                             {3 * kMs, true},
                             {4 * kMs, false},
                             {7 * kMs, true},
                             {500 * kMs, false},
                             {502 * kMs, true},
                             {504 * kMs, false}},
                            kSecond);
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_TRUE(changes[0].down);
  EXPECT_EQ(changes[0].at, 0);
  EXPECT_FALSE(changes[1].down);
  EXPECT_EQ(changes[1].at, 500 * kMs);
}

TEST(Contact, TakesAShortSpikeForNothing) {
  Contact contact(5 * kMs);
  EXPECT_TRUE(Play(contact, {{0, true}, {2 * kMs, false}}, kSecond).empty());
  EXPECT_FALSE(contact.NextDeadline());
}

TEST(Contact, CountsHoldingToWhatMayBeItsRelease) {
  Contact contact(5 * kMs);
  Play(contact, {{0, true}}, 100 * kMs);
  EXPECT_EQ(contact.Held_us(100 * kMs), 100 * kMs);
  contact.OnEdge(100 * kMs, false);
  EXPECT_EQ(contact.Held_us(104 * kMs), 100 * kMs);
  contact.OnEdge(104 * kMs, true);  // it was bounce
  EXPECT_EQ(contact.Held_us(110 * kMs), 110 * kMs);
}

TEST(Contact, WithAnyBounceShorterThanItsTimeTellsExactlyTheUsersPresses) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 engine(seed);
    const auto draw = [&](Utime lo, Utime hi) {
      return lo + static_cast<Utime>(engine() % static_cast<uint64_t>(hi - lo + 1));
    };
    std::vector<std::pair<Utime, bool>> edges;
    std::vector<std::pair<Utime, bool>> meant;
    Utime now = 0;
    for (int i = 0; i < 40; ++i) {
      const bool down = i % 2 == 0;
      now += draw(20 * kMs, 300 * kMs);
      meant.emplace_back(now, down);
      edges.emplace_back(now, down);
      Utime at = now;
      for (Utime bounces = draw(0, 4); bounces > 0; --bounces) {
        edges.emplace_back(at += draw(1, kMs), !down);
        edges.emplace_back(at += draw(1, kMs), down);
      }
    }
    Contact contact(5 * kMs);
    const auto changes = Play(contact, edges, now + kSecond);
    ASSERT_EQ(changes.size(), meant.size()) << "seed " << seed;
    for (size_t i = 0; i < meant.size(); ++i) {
      ASSERT_EQ(changes[i].at, meant[i].first) << "seed " << seed;
      ASSERT_EQ(changes[i].down, meant[i].second) << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace beckon::ui_bridge::scan
