#include "services/ui_bridge/speech/sound.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>
#include <string_view>

#include "services/ui_bridge/speech/acoustics.h"

namespace beckon::ui_bridge::speech {
namespace {

constexpr double kUsualLevel = 3000;  // root mean square of the loud frames
constexpr double kMostGain = 31.6;
constexpr double kHiss = 20;  // 43 dB below that
constexpr double kLoudShare = 0.9;
constexpr int kTaps = 16;  // zero crossings on either side

uint32_t Number(std::span<const uint8_t> bytes, size_t at, size_t n) {
  uint32_t number = 0;
  for (size_t i = 0; i < n; ++i) number |= static_cast<uint32_t>(bytes[at + i]) << (8 * i);
  return number;
}

void Append(std::vector<uint8_t>& bytes, uint32_t number, size_t n) {
  for (size_t i = 0; i < n; ++i) bytes.push_back(static_cast<uint8_t>(number >> (8 * i)));
}

bool Is(std::span<const uint8_t> bytes, size_t at, const char* tag) {
  return std::memcmp(bytes.data() + at, tag, 4) == 0;
}

}  // namespace

Result<Wave> ReadWave(std::span<const uint8_t> bytes) {
  if (bytes.size() < 12 || !Is(bytes, 0, "RIFF") || !Is(bytes, 8, "WAVE"))
    return Error{"WAV: expected RIFF and WAVE at its beginning"};
  Wave wave;
  bool has_format = false;
  for (size_t at = 12; at + 8 <= bytes.size();) {
    const size_t length = Number(bytes, at + 4, 4);
    const size_t begin = at + 8;
    if (Is(bytes, at, "fmt ")) {
      if (length < 16 || begin + 16 > bytes.size()) return Error{"WAV: its format is cut off"};
      if (Number(bytes, begin, 2) != 1 || Number(bytes, begin + 2, 2) != 1 ||
          Number(bytes, begin + 14, 2) != 16) {
        return Error{"WAV: expected one channel of 16 bit PCM"};
      }
      const uint32_t rate = Number(bytes, begin + 4, 4);
      if (rate < 4'000 || rate > 192'000)
        return Error{"WAV: expected 4 to 192 kHz, found " + std::to_string(rate) + " Hz"};
      wave.sample_rate = static_cast<int>(rate);
      has_format = true;
    } else if (Is(bytes, at, "data")) {
      if (!has_format) return Error{"WAV: samples before their format"};
      const size_t n = std::min(length, bytes.size() - begin) / 2;
      for (size_t i = 0; i < n; ++i)
        wave.samples.push_back(static_cast<int16_t>(Number(bytes, begin + 2 * i, 2)));
      return wave;
    }
    if (length > bytes.size() - begin) break;
    at = begin + length + (length & 1);
  }
  return Error{"WAV: no samples"};
}

std::vector<uint8_t> WriteWave(const Wave& wave) {
  std::vector<uint8_t> bytes;
  const auto tag = [&](std::string_view name) {
    for (const char c : name) bytes.push_back(static_cast<uint8_t>(c));
  };
  const auto length = static_cast<uint32_t>(2 * wave.samples.size());
  const auto rate = static_cast<uint32_t>(wave.sample_rate);
  tag("RIFF");
  Append(bytes, 36 + length, 4);
  tag("WAVE");
  tag("fmt ");
  Append(bytes, 16, 4);
  Append(bytes, 1, 2);
  Append(bytes, 1, 2);
  Append(bytes, rate, 4);
  Append(bytes, 2 * rate, 4);
  Append(bytes, 2, 2);
  Append(bytes, 16, 2);
  tag("data");
  Append(bytes, length, 4);
  for (const int16_t sample : wave.samples) Append(bytes, static_cast<uint16_t>(sample), 2);
  return bytes;
}

std::vector<int16_t> AtSampleRate(const Wave& wave) {
  if (wave.sample_rate == kSampleRate) return wave.samples;
  const double step = static_cast<double>(wave.sample_rate) / kSampleRate;
  const double cutoff = std::min(1.0, 1 / step);  // of the input's Nyquist frequency
  const double reach = kTaps / cutoff;
  const auto n = static_cast<int64_t>(wave.samples.size());
  std::vector<int16_t> result(static_cast<size_t>(static_cast<double>(n) / step));
  for (size_t i = 0; i < result.size(); ++i) {
    const double at = static_cast<double>(i) * step;
    double sum = 0;
    const auto first = std::max<int64_t>(0, static_cast<int64_t>(std::ceil(at - reach)));
    const auto last = std::min(n - 1, static_cast<int64_t>(std::floor(at + reach)));
    for (int64_t j = first; j <= last; ++j) {
      const double x = (static_cast<double>(j) - at) * cutoff * std::numbers::pi;
      const double sinc = std::abs(x) < 1e-9 ? 1 : std::sin(x) / x;
      const double window =
          0.5 + 0.5 * std::cos(std::numbers::pi * (static_cast<double>(j) - at) / reach);
      sum += wave.samples[static_cast<size_t>(j)] * sinc * window * cutoff;
    }
    result[i] = static_cast<int16_t>(std::clamp(std::round(sum), -32768.0, 32767.0));
  }
  return result;
}

std::vector<int16_t> Levelled(std::span<const int16_t> samples) {
  std::vector<double> levels;
  for (size_t i = 0; i + kSamplesPerFrame <= samples.size(); i += kSamplesPerFrame) {
    double sum = 0;
    for (size_t j = i; j < i + kSamplesPerFrame; ++j)
      sum += static_cast<double>(samples[j]) * samples[j];
    levels.push_back(std::sqrt(sum / kSamplesPerFrame));
  }
  std::vector<int16_t> result(samples.begin(), samples.end());
  if (levels.empty()) return result;
  const auto nth =
      levels.begin() + static_cast<ptrdiff_t>(kLoudShare * static_cast<double>(levels.size() - 1));
  std::ranges::nth_element(levels, nth);
  const double gain = std::clamp(kUsualLevel / std::max(1.0, *nth), 1 / kMostGain, kMostGain);
  std::minstd_rand random(1);
  for (auto& sample : result) {
    double hiss = -6;  // of twelve uniform draws: nearly normal, of deviation 1
    for (int i = 0; i < 12; ++i) hiss += static_cast<double>(random()) / std::minstd_rand::max();
    sample = static_cast<int16_t>(
        std::clamp(std::round(sample * gain + kHiss * hiss), -32768.0, 32767.0));
  }
  return result;
}

}  // namespace beckon::ui_bridge::speech
