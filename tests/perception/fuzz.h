// What fuzzing feeds perception: bytes that choose hostile images and settings. The seeded test and
// the libFuzzer programs share it.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace beckon::perception {

/// Segments the image that `bytes` choose by the fast method, and by the reference. What is wrong
/// with the result; empty where nothing is.
std::string FuzzFast(std::span<const uint8_t> bytes);
std::string FuzzReference(std::span<const uint8_t> bytes);

/// Perceives some images that `bytes` choose one after the other, as the service does with what
/// arrives, and makes a SCENE of each. What is wrong with one; empty where nothing is.
std::string FuzzPerceiver(std::span<const uint8_t> bytes);

}  // namespace beckon::perception
