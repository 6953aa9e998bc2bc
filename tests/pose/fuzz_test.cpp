// Seeded bytes through what the fuzzers share: every estimate is sound, every scene is answered.
#include "tests/pose/fuzz.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace beckon::pose {
namespace {

using Harness = std::string (*)(std::span<const uint8_t>);

void ExpectSoundForAnyBytes(Harness harness, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    std::mt19937 engine(static_cast<unsigned>(round));
    std::vector<uint8_t> bytes(engine() % 2000);
    for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(engine());
    ASSERT_EQ(harness(bytes), "") << "round " << round;
  }
}

TEST(Fuzz, AnyCloudIsFittedOrRefusedWithAReason) { ExpectSoundForAnyBytes(FuzzFit, 600); }

TEST(Fuzz, AnySceneThatDecodesIsAnswered) { ExpectSoundForAnyBytes(FuzzScene, 600); }

}  // namespace
}  // namespace beckon::pose
