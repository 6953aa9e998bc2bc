// WAV in and out, sample rates, levels.
#include "services/ui_bridge/speech/sound.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "services/ui_bridge/speech/acoustics.h"

namespace beckon::ui_bridge::speech {
namespace {

std::vector<int16_t> Tone(int rate, double hertz, double level, int samples) {
  std::vector<int16_t> tone;
  for (int i = 0; i < samples; ++i) {
    tone.push_back(static_cast<int16_t>(
        std::lround(level * std::sin(2 * std::numbers::pi * hertz * i / rate))));
  }
  return tone;
}

double Rms(const std::vector<int16_t>& samples) {
  double sum = 0;
  for (const int16_t x : samples) sum += static_cast<double>(x) * x;
  return std::sqrt(sum / static_cast<double>(samples.size()));
}

TEST(Waves, ComeBackAsTheyWere) {
  const Wave wave{22'050, Tone(22'050, 440, 9000, 1000)};
  const auto read = ReadWave(WriteWave(wave));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->sample_rate, wave.sample_rate);
  EXPECT_EQ(read->samples, wave.samples);
}

TEST(Waves, OfUnknownLengthGoToTheEnd) {
  auto bytes = WriteWave({16'000, {1, 2, 3}});
  for (size_t i = 40; i < 44; ++i) bytes[i] = 0xff;
  const auto read = ReadWave(bytes);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->samples, (std::vector<int16_t>{1, 2, 3}));
}

TEST(Waves, AreRefusedWhereTheyAreNone) {
  EXPECT_FALSE(ReadWave({}));
  auto stereo = WriteWave({16'000, {1, 2}});
  stereo[22] = 2;
  EXPECT_FALSE(ReadWave(stereo));
}

TEST(Waves, OfAnyBytesDoNoHarm) {
  std::mt19937_64 random(4);
  const auto right = WriteWave({16'000, Tone(16'000, 300, 100, 200)});
  int read = 0;
  for (int i = 0; i < 20'000; ++i) {
    auto bytes = right;
    bytes.resize(random() % (bytes.size() + 1));
    for (size_t n = random() % 6; n > 0 && !bytes.empty(); --n)
      bytes[random() % std::min<size_t>(bytes.size(), 60)] = static_cast<uint8_t>(random());
    read += ReadWave(bytes) ? 1 : 0;
  }
  EXPECT_GT(read, 100);
}

TEST(Rates, KeepAToneAndTakeAwayWhatDoesNotFit) {
  const auto low = AtSampleRate({22'050, Tone(22'050, 1000, 9000, 22'050)});
  EXPECT_NEAR(static_cast<double>(low.size()), 16'000, 2);
  EXPECT_NEAR(Rms(low), 9000 / std::sqrt(2), 200);
  EXPECT_LT(Rms(AtSampleRate({22'050, Tone(22'050, 10'000, 9000, 22'050)})), 300);
}

TEST(Levels, BecomeUsual) {
  const auto soft = Levelled(Tone(kSampleRate, 500, 300, 16'000));
  const auto loud = Levelled(Tone(kSampleRate, 500, 20'000, 16'000));
  EXPECT_NEAR(Rms(soft), 3000, 100);
  EXPECT_NEAR(Rms(loud), 3000, 100);
  EXPECT_TRUE(Levelled({}).empty());
  EXPECT_NEAR(Rms(Levelled(std::vector<int16_t>(16'000, 0))), 20, 1) << "hiss";
}

}  // namespace
}  // namespace beckon::ui_bridge::speech
