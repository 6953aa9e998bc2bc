// Seeded bytes through what the fuzzer shares.
#include "tests/lcmtypes/frame_fuzz.h"

#include <gtest/gtest.h>

#include "tests/fuzz_rounds.h"

namespace beckon {
namespace {

TEST(FrameFuzz, ADamagedFrameIsAnImageOfTheSizeItSaysOrIsRefusedWithAReason) {
  ExpectSoundForAnyBytes(FuzzFrame, 400, 6000);
}

}  // namespace
}  // namespace beckon
