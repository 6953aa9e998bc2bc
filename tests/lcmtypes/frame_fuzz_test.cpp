// Seeded bytes through what the fuzzer shares.
#include "tests/lcmtypes/frame_fuzz.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace beckon {
namespace {

TEST(FrameFuzz, ADamagedFrameIsAnImageOfTheSizeItSaysOrIsRefusedWithAReason) {
  for (unsigned round = 0; round < 6000; ++round) {
    std::mt19937 engine(round);
    std::vector<uint8_t> bytes(engine() % 400);
    for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(engine());
    ASSERT_EQ(FuzzFrame(bytes), "") << "round " << round;
  }
}

}  // namespace
}  // namespace beckon
