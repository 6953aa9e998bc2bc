// What fuzzers run on bytes they choose, run on seeded ones in every test run.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace beckon {

/// Expects that `harness` finds nothing wrong, round after round, with up to `most_bytes` bytes
/// that follow from the round's number.
inline void ExpectSoundForAnyBytes(std::string (*harness)(std::span<const uint8_t>),
                                   size_t most_bytes, unsigned rounds) {
  for (unsigned round = 0; round < rounds; ++round) {
    std::mt19937 engine(round);
    std::vector<uint8_t> bytes(engine() % most_bytes);
    for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(engine());
    ASSERT_EQ(harness(bytes), "") << "round " << round;
  }
}

}  // namespace beckon
