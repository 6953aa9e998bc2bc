// What fuzzing feeds the pose service: bytes that choose a hostile cloud, or a SCENE on the bus.
// The seeded test and the libFuzzer programs share it.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace beckon::pose {

/// Fits the cloud that `bytes` choose, by the method they choose. What is wrong with the estimate;
/// empty where nothing is.
std::string FuzzFit(std::span<const uint8_t> bytes);

/// Encodes a SCENE of the clouds that `bytes` choose, writes some of them over it, and answers it
/// where it still decodes, as the service does. What is wrong with the answer; empty where nothing
/// is.
std::string FuzzScene(std::span<const uint8_t> bytes);

}  // namespace beckon::pose
