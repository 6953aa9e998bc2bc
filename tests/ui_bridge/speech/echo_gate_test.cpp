// A prompt that comes back through the microphone is no speech; a user over it is.
#include "services/ui_bridge/speech/echo_gate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "services/ui_bridge/speech/segmenter.h"

namespace beckon::ui_bridge::speech {
namespace {

/// Sound with the rhythm of speech: syllables of changing loudness.
std::vector<int16_t> Babbled(double seconds, double level, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, 1);
  std::vector<int16_t> samples;
  while (static_cast<double>(samples.size()) < seconds * kSampleRate) {
    const double loud = level * std::pow(10, -static_cast<double>(random() % 18) / 20);
    const auto length = 1'200 + random() % 2'400;
    for (size_t i = 0; i < length; ++i)
      samples.push_back(static_cast<int16_t>(loud * noise(random)));
    samples.insert(samples.end(), 400 + random() % 800, 0);
  }
  return samples;
}

class EchoTest : public ::testing::Test {
 protected:
  /// Plays `prompt`, which arrives `delay` frames later and changed by `gain_dB`, with a user's
  /// `speech` on top from frame `at` on. The number of beginnings of speech that were seen.
  int Play(const std::vector<int16_t>& prompt, double gain_dB, int delay,
           const std::vector<int16_t>& speech = {}, int at = 0) {
    const int64_t begin = segmenter_.frames();
    gate_.Start(Levels_dB(prompt), begin);
    const double gain = std::pow(10, gain_dB / 20);
    const auto frames = static_cast<int>(prompt.size() / kSamplesPerFrame) + delay + 80;
    std::normal_distribution<double> noise(0, 15);
    int begun = 0;
    for (int t = 0; t < frames; ++t) {
      std::vector<int16_t> frame(kSamplesPerFrame);
      for (size_t i = 0; i < frame.size(); ++i) {
        double x = noise(random_);
        const auto from = static_cast<int64_t>(i) + (t - delay) * int64_t{kSamplesPerFrame};
        if (from >= 0 && from < static_cast<int64_t>(prompt.size()))
          x += gain * prompt[static_cast<size_t>(from)];
        const auto said = static_cast<int64_t>(i) + (t - at) * int64_t{kSamplesPerFrame};
        if (said >= 0 && said < static_cast<int64_t>(speech.size()))
          x += speech[static_cast<size_t>(said)];
        frame[i] = static_cast<int16_t>(std::clamp(x, -32768.0, 32767.0));
      }
      const bool was = segmenter_.speaking();
      const int64_t now = segmenter_.frames();
      segmenter_.Push(frame, gate_.Expected_dB(now));
      gate_.Observe(now, segmenter_.level_dB(), segmenter_.floor_dB());
      if (!was && segmenter_.speaking()) {
        ++begun;
        began_at_ = t;
      }
    }
    return begun;
  }

  void Quiet(int frames) {
    std::normal_distribution<double> noise(0, 15);
    for (int t = 0; t < frames; ++t) {
      std::vector<int16_t> frame(kSamplesPerFrame);
      for (auto& x : frame) x = static_cast<int16_t>(noise(random_));
      segmenter_.Push(frame, gate_.Expected_dB(segmenter_.frames()));
    }
  }

  std::mt19937_64 random_{3};
  Segmenter segmenter_;
  EchoGate gate_;
  int began_at_ = -1;
};

TEST_F(EchoTest, ItsOwnPromptIsNoSpeechAtAnyLevelAndDelay) {
  uint64_t seed = 1;
  for (const double gain_dB : {-40.0, -25.0, -12.0, -6.0, 0.0, 6.0}) {
    for (const int delay : {0, 8, 25, 45}) {
      segmenter_ = Segmenter();
      gate_ = EchoGate();
      Quiet(150);
      EXPECT_EQ(Play(Babbled(3, 2500, ++seed), gain_dB, delay), 0) << gain_dB << " dB, " << delay;
    }
  }
}

TEST_F(EchoTest, LearnsHowLoudAndHowLateItIs) {
  Quiet(150);
  Play(Babbled(4, 2500, 5), -10, 12);
  ASSERT_TRUE(gate_.gain_dB());
  EXPECT_NEAR(*gate_.gain_dB(), -10, 2);
  EXPECT_NEAR(gate_.delay(), 12, 1);
}

TEST_F(EchoTest, AUserOverThePromptIsHeardAtOnce) {
  Quiet(150);
  Play(Babbled(3, 2500, 6), -15, 10);  // learns
  Quiet(100);
  EXPECT_GE(Play(Babbled(4, 2500, 7), -15, 10, Babbled(0.6, 9000, 8), 150), 1);
  EXPECT_NEAR(began_at_, 152, 25);
}

TEST_F(EchoTest, NothingIsExpectedOnceThePromptIsOver) {
  Quiet(150);
  Play(Babbled(2, 2500, 9), -10, 10);
  Quiet(200);
  EXPECT_EQ(gate_.Expected_dB(segmenter_.frames()), kNoLevel_dB);
}

TEST_F(EchoTest, AnEmptyPromptHarmsNothing) {
  gate_.Start({}, 0);
  gate_.Observe(0, -30, -60);
  gate_.Stop(0);
  EXPECT_NO_THROW(gate_.Expected_dB(1));
}

}  // namespace
}  // namespace beckon::ui_bridge::speech
