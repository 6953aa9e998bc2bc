// Speech for experiments: espeak-ng's voices, mixed with noise.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "services/base/result.h"

namespace beckon::bench {

using Sound = std::vector<int16_t>;  // 16 kHz, one channel

struct Voice {
  std::string name;  // of espeak-ng -v
  int speed = 160;   // words a minute
  int pitch = 50;    // 0 .. 99
};

enum class Noise { kQuiet, kWhite, kBabble };
const char* Name(Noise noise);

/// Runs espeak-ng.
Result<Sound> Speak(const Voice& voice, const std::string& text);

/// Several voices at once, `seconds` long, of level 1 (root mean square, before it is scaled).
Result<std::vector<double>> Babble(double seconds, uint64_t seed);

/// `speech` with 0.7 s before and 0.8 s after it, in noise: `snr_dB` is that of the speech's loud
/// frames. Quiet is a noise 50 dB below. `gain_dB` is the whole recording's.
Sound Record(const Sound& speech, Noise noise, double snr_dB, double gain_dB,
             const std::vector<double>& babble, std::mt19937_64& random);

}  // namespace beckon::bench
