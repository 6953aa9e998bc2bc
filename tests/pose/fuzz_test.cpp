// Seeded bytes through what the fuzzers share: every estimate is sound, every scene is answered.
#include "tests/pose/fuzz.h"

#include <gtest/gtest.h>

#include "tests/fuzz_rounds.h"

namespace beckon::pose {
namespace {

TEST(Fuzz, AnyCloudIsFittedOrRefusedWithAReason) { ExpectSoundForAnyBytes(FuzzFit, 2000, 600); }

TEST(Fuzz, AnySceneThatDecodesIsAnswered) { ExpectSoundForAnyBytes(FuzzScene, 2000, 600); }

}  // namespace
}  // namespace beckon::pose
