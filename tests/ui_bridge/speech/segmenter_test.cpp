// Finding speech: what is loud against the room, once it has ended.
#include "services/ui_bridge/speech/segmenter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace beckon::ui_bridge::speech {
namespace {

using Frame = std::vector<int16_t>;

class SegmenterTest : public ::testing::Test {
 protected:
  Frame Noise(double level) {
    std::normal_distribution<double> noise(0, level);
    Frame frame(kSamplesPerFrame);
    for (auto& x : frame) x = static_cast<int16_t>(std::clamp(noise(random_), -32768.0, 32767.0));
    return frame;
  }

  /// Pushes `frames` of noise; collects what comes out.
  void Push(int frames, double level, double echo_dB = kNoLevel_dB) {
    for (int i = 0; i < frames; ++i) {
      if (auto segment = segmenter_.Push(Noise(level), echo_dB)) out_.push_back(*segment);
    }
  }

  std::vector<Segment> Ended() const {
    std::vector<Segment> ended;
    for (const auto& segment : out_) {
      if (segment.ended) ended.push_back(segment);
    }
    return ended;
  }

  std::mt19937_64 random_{1};
  Segmenter segmenter_;
  std::vector<Segment> out_;
};

TEST_F(SegmenterTest, GivesWhatIsSaidOnceItEnded) {
  Push(100, 20);
  Push(40, 2000);
  EXPECT_TRUE(segmenter_.speaking());
  EXPECT_TRUE(Ended().empty());
  Push(60, 20);
  ASSERT_EQ(Ended().size(), 1u);
  const auto segment = Ended().front();
  EXPECT_NEAR(segment.loud_end - segment.loud_begin, 40, 2);
  EXPECT_NEAR(static_cast<double>(segment.begin_frame + segment.loud_begin), 100, 2);
  EXPECT_EQ(segment.samples.size() % kSamplesPerFrame, 0u);
}

TEST_F(SegmenterTest, TellsOfAPauseBeforeTheEnd) {
  Push(100, 20);
  Push(40, 2000);
  Push(20, 20);
  ASSERT_EQ(out_.size(), 1u);
  EXPECT_FALSE(out_.front().ended);
}

TEST_F(SegmenterTest, HearsNothingInSteadyNoiseOfAnyLevel) {
  for (const double level : {0.0, 5.0, 100.0, 3000.0, 12000.0}) {
    segmenter_ = Segmenter();
    Push(600, level);
    EXPECT_TRUE(out_.empty()) << level;
  }
}

TEST_F(SegmenterTest, FollowsARoomThatBecomesLouder) {
  Push(200, 20);
  Push(1200, 400);
  out_.clear();
  Push(300, 400);
  EXPECT_TRUE(Ended().empty());
  Push(40, 4000);
  Push(60, 400);
  EXPECT_EQ(Ended().size(), 1u);
}

TEST_F(SegmenterTest, IgnoresClicks) {
  Push(100, 20);
  Push(2, 20000);
  Push(100, 20);
  EXPECT_TRUE(out_.empty());
}

TEST_F(SegmenterTest, CutsWhatNeverEnds) {
  Push(100, 20);
  for (int i = 0; i < 30; ++i) {  // with gaps, as speech has
    Push(25, 3000);
    Push(5, 20);
  }
  const auto ended = Ended();
  ASSERT_FALSE(ended.empty());
  EXPECT_TRUE(ended.front().cut);
  EXPECT_LE(ended.front().samples.size(), 400u * kSamplesPerFrame);
}

TEST_F(SegmenterTest, WantsSpeechToBeLouderThanTheEcho) {
  Push(100, 20);
  const double echo_dB = LevelMeter().Push(Noise(2000)) + 6;
  Push(60, 2000, echo_dB);
  Push(60, 20);
  EXPECT_TRUE(out_.empty());
  Push(40, 12000, echo_dB);
  Push(60, 20);
  EXPECT_EQ(Ended().size(), 1u);
}

TEST_F(SegmenterTest, TakesAnySamplesWithoutEndOrHarm) {
  std::mt19937_64 random(7);
  Segmenter segmenter;
  for (int i = 0; i < 20'000; ++i) {
    Frame frame(kSamplesPerFrame);
    const auto kind = random() % 4;
    for (auto& x : frame)
      x = kind == 0   ? static_cast<int16_t>(random())
          : kind == 1 ? 0
          : kind == 2 ? INT16_MIN
                      : INT16_MAX;
    const double echo = random() % 5 == 0 ? std::nan("") : kNoLevel_dB;
    const auto segment = segmenter.Push(frame, echo);
    if (!segment) continue;
    EXPECT_LE(segment->loud_begin, segment->loud_end);
    EXPECT_LE(static_cast<size_t>(segment->loud_end) * kSamplesPerFrame, segment->samples.size());
    EXPECT_LE(segment->samples.size(), 401u * kSamplesPerFrame);
  }
  EXPECT_TRUE(std::isfinite(segmenter.floor_dB()));
}

}  // namespace
}  // namespace beckon::ui_bridge::speech
