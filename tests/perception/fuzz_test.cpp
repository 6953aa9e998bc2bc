// Seeded bytes through what the fuzzers share: every segmentation is sound, every scene can be
// sent.
#include "tests/perception/fuzz.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace beckon::perception {
namespace {

using Harness = std::string (*)(std::span<const uint8_t>);

void ExpectSoundForAnyBytes(Harness harness, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    std::mt19937 engine(static_cast<unsigned>(round));
    std::vector<uint8_t> bytes(engine() % 300);
    for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(engine());
    ASSERT_EQ(harness(bytes), "") << "round " << round;
  }
}

TEST(Fuzz, AnyImageIsSegmentedSoundlyByTheFastMethod) { ExpectSoundForAnyBytes(FuzzFast, 300); }

TEST(Fuzz, AnyImageIsSegmentedSoundlyByTheReference) { ExpectSoundForAnyBytes(FuzzReference, 100); }

TEST(Fuzz, AnyImagesOneAfterTheOtherGiveScenesThatCanBeSent) {
  ExpectSoundForAnyBytes(FuzzPerceiver, 80);
}

}  // namespace
}  // namespace beckon::perception
