// Sound in memory: WAV as espeak-ng writes it, other sample rates, levels.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "services/base/result.h"

namespace beckon::ui_bridge::speech {

struct Wave {
  int sample_rate = 16'000;  // Hz, 4 000 .. 192 000
  std::vector<int16_t> samples;
};

/// One channel of 16 bits. A length that is not known (a stream) means the rest of `bytes`.
Result<Wave> ReadWave(std::span<const uint8_t> bytes);
std::vector<uint8_t> WriteWave(const Wave& wave);

/// At kSampleRate, band-limited (windowed sinc).
std::vector<int16_t> AtSampleRate(const Wave& wave);

/// Made louder or softer so that its loud parts have the level that the acoustic model is used to,
/// but by no more than 30 dB; with a soft hiss under it, 43 dB below. The model was made of
/// recordings and knows no silence as deep as a good microphone's.
/// The same samples give the same result.
std::vector<int16_t> Levelled(std::span<const int16_t> samples);

}  // namespace beckon::ui_bridge::speech
