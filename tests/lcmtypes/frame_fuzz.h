// What fuzzing feeds the reader of FRAME messages: bytes that choose a frame and what damages it.
// The seeded test and the libFuzzer program share it.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace beckon {

/// Encodes a frame that `bytes` choose, damages its images, its fields and its encoding as they
/// choose, mostly under checksums that are right again, and reads it as perception does. What is
/// wrong with the answer, an image whose sizes agree or an error that says why; empty where nothing
/// is.
std::string FuzzFrame(std::span<const uint8_t> bytes);

}  // namespace beckon
