// The damage done to datagrams.
#include "tests/faults/mutator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

namespace beckon::faults {
namespace {

Datagram Real(const std::string& channel, size_t size) {
  std::string text = "LC02....";
  text += channel;
  text += '\0';
  text += std::string(size, 'm');
  return {text.begin(), text.end()};
}

const std::vector<Datagram> kReal = {Real("BECKON_QUERY", 300), Real("BECKON_TASK", 500)};

TEST(MutatorTest, NearlyAlwaysDamagesAndNeverMakesAFragment) {
  Mutator mutator(1);
  int unhurt = 0;
  for (int i = 0; i < 5000; ++i) {
    const Datagram made = mutator.Mutate(kReal);
    EXPECT_FALSE(IsFragment(made));
    EXPECT_LE(made.size(), 65'000u);
    unhurt += std::ranges::count(kReal, made) > 0 ? 1 : 0;
  }
  EXPECT_LT(unhurt, 250);
}

TEST(MutatorTest, DamageOfEveryKindReachesLcmsDecoder) {
  Mutator mutator(1);
  int for_lcm = 0, noise = 0, longer = 0, shorter = 0;
  for (int i = 0; i < 5000; ++i) {
    const Datagram made = mutator.Mutate(kReal);
    const bool headed = made.size() > 8 && std::string(made.begin(), made.begin() + 4) == "LC02";
    ++(headed ? for_lcm : noise);
    longer += made.size() > 550 ? 1 : 0;
    shorter += made.size() < 300 ? 1 : 0;
  }
  EXPECT_GT(for_lcm, 2500);
  for (const int some : {noise, longer, shorter}) EXPECT_GT(some, 200);
}

TEST(MutatorTest, HostileFragmentsAreFragmentsWithOffsetsThatWrap) {
  Mutator mutator(1);
  std::set<uint8_t> first_of_offset;
  for (int i = 0; i < 1000; ++i) {
    const Datagram made = mutator.HostileFragment();
    ASSERT_TRUE(IsFragment(made));
    first_of_offset.insert(made[12]);
  }
  EXPECT_TRUE(first_of_offset.contains(0xff));
}

TEST(MutatorTest, TheSeedDecidesEverything) {
  Mutator one(3), same(3), other(4);
  int differences = 0;
  for (int i = 0; i < 200; ++i) {
    const Datagram made = one.Mutate(kReal);
    EXPECT_EQ(made, same.Mutate(kReal));
    differences += made == other.Mutate(kReal) ? 0 : 1;
  }
  EXPECT_GT(differences, 100);
}

}  // namespace
}  // namespace beckon::faults
