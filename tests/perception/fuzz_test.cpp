// Seeded bytes through what the fuzzers share: every segmentation is sound, every scene can be
// sent.
#include "tests/perception/fuzz.h"

#include <gtest/gtest.h>

#include "tests/fuzz_rounds.h"

namespace beckon::perception {
namespace {

TEST(Fuzz, AnyImageIsSegmentedSoundlyByTheFastMethod) {
  ExpectSoundForAnyBytes(FuzzFast, 300, 300);
}

TEST(Fuzz, AnyImageIsSegmentedSoundlyByTheReference) {
  ExpectSoundForAnyBytes(FuzzReference, 300, 100);
}

TEST(Fuzz, AnyImagesOneAfterTheOtherGiveScenesThatCanBeSent) {
  ExpectSoundForAnyBytes(FuzzPerceiver, 300, 80);
}

}  // namespace
}  // namespace beckon::perception
