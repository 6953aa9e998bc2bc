#include "bench/speech/mouth.h"

#include <algorithm>
#include <cmath>

#include "services/ui_bridge/speech/espeak.h"
#include "services/ui_bridge/speech/sound.h"

namespace beckon::bench {
namespace {

namespace speech = ui_bridge::speech;

constexpr size_t kBefore = 11'200;
constexpr size_t kAfter = 12'800;
constexpr double kQuiet_dB = 50;

/// Root mean square of the frames that are not silent.
double LoudLevel(const Sound& sound) {
  std::vector<double> levels;
  for (size_t i = 0; i + 160 <= sound.size(); i += 160) {
    double sum = 0;
    for (size_t j = i; j < i + 160; ++j) sum += static_cast<double>(sound[j]) * sound[j];
    levels.push_back(std::sqrt(sum / 160));
  }
  if (levels.empty()) return 1;
  const double loudest = *std::ranges::max_element(levels);
  double sum = 0;
  double n = 0;
  for (const double level : levels) {
    if (level < loudest * 0.1) continue;
    sum += level * level;
    ++n;
  }
  return std::max(1.0, std::sqrt(sum / std::max(1.0, n)));
}

}  // namespace

const char* Name(Noise noise) {
  return noise == Noise::kQuiet ? "quiet" : noise == Noise::kWhite ? "white" : "babble";
}

Result<Sound> Speak(const Voice& voice, const std::string& text) {
  auto wave = speech::SpeakToWave(
      {.voice = voice.name, .words_per_minute = voice.speed, .pitch = voice.pitch}, text);
  if (!wave) return wave.error();
  return speech::AtSampleRate(*wave);
}

Result<std::vector<double>> Babble(double seconds, uint64_t seed) {
  static const std::vector<std::string> voices = {"en-gb+m1", "en-us+f2",  "en-gb-scotland+m6",
                                                  "en-us+f5", "en-029+m3", "en-gb-x-rp+f1"};
  static const std::vector<std::string> texts = {
      "the train was late again this morning and nobody knew why it had waited outside the station",
      "she said the weather would turn by the weekend so we should bring coats for the children",
      "have you heard about the new bakery they opened near the bridge it sells very good bread",
      "my brother is painting the kitchen yellow although his wife would rather have had it green",
      "we walked along the river for hours and then had soup in a small restaurant by the mill",
      "the match ended two all because the keeper dropped a ball that anybody could have held"};
  std::mt19937_64 random(seed);
  const auto n = static_cast<size_t>(seconds * 16'000);
  std::vector<double> sum(n, 0);
  for (size_t v = 0; v < voices.size(); ++v) {
    size_t at = 0;
    size_t text = v;
    while (at < n) {
      auto sound = Speak({voices[v], static_cast<int>(140 + random() % 50), 50},
                         texts[text++ % texts.size()]);
      if (!sound) return sound.error();
      const double level = LoudLevel(*sound);
      for (size_t i = 0; i < sound->size() && at < n; ++i, ++at) sum[at] += (*sound)[i] / level;
      if (sound->empty()) break;
    }
  }
  double power = 0;
  for (const double x : sum) power += x * x;
  const double level = std::sqrt(power / static_cast<double>(n));
  for (double& x : sum) x /= level;
  return sum;
}

Sound Record(const Sound& said, Noise noise, double snr_dB, double gain_dB,
             const std::vector<double>& babble, std::mt19937_64& random) {
  std::vector<double> mixed(kBefore + said.size() + kAfter, 0);
  const double level = 3000;
  const double scale = level / LoudLevel(said);
  for (size_t i = 0; i < said.size(); ++i) mixed[kBefore + i] = said[i] * scale;
  const double snr = noise == Noise::kQuiet ? kQuiet_dB : snr_dB;
  const double noise_level = level * std::pow(10, -snr / 20);
  std::normal_distribution<double> white(0, noise_level);
  const size_t from = babble.empty() ? 0 : random() % babble.size();
  for (size_t i = 0; i < mixed.size(); ++i)
    mixed[i] +=
        noise == Noise::kBabble ? noise_level * babble[(from + i) % babble.size()] : white(random);
  Sound sound(mixed.size());
  const double gain = std::pow(10, gain_dB / 20);
  for (size_t i = 0; i < mixed.size(); ++i)
    sound[i] = static_cast<int16_t>(std::clamp(std::round(mixed[i] * gain), -32768.0, 32767.0));
  return sound;
}

}  // namespace beckon::bench
