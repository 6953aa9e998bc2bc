// From sounds to commands: probabilities that sum to one, what speaks against a phrase, and who may
// do what.
#include "services/ui_bridge/speech/judgement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "services/ui_bridge/speech/turn.h"

namespace beckon::ui_bridge::speech {
namespace {

Grammar YesNoStop() {
  Grammar grammar;
  grammar.commands = {{CommandKind::kOption, 0, {"yes"}},
                      {CommandKind::kOption, 1, {"no"}},
                      {CommandKind::kStop, 0, {"stop"}},
                      {CommandKind::kResume, 0, {"resume"}}};
  grammar.phrases = {{0, *ParsePronunciation("Y EH S")},
                     {1, *ParsePronunciation("N OW")},
                     {2, *ParsePronunciation("S T AA P")},
                     {std::nullopt, *ParsePronunciation("G OW")}};
  return grammar;
}

/// `frames` of sound that phones fit with `each` nats a frame.
Alignment Align(const Pronunciation& sounds, int frames, double each) {
  Alignment alignment;
  const int n = static_cast<int>(sounds.size());
  for (int i = 0; i < n; ++i) {
    const int begin = frames * i / n;
    const int end = frames * (i + 1) / n;
    alignment.push_back({sounds[static_cast<size_t>(i)], begin, end, each * (end - begin)});
  }
  return alignment;
}

Acoustics Sound(const Grammar& grammar, const std::vector<double>& fits) {
  Acoustics acoustics;
  acoustics.frames = 40;
  acoustics.free = Align(grammar.phrases[0].sounds, 40, -5);
  for (size_t i = 0; i < fits.size(); ++i)
    acoustics.phrases.emplace_back(Align(grammar.phrases[i].sounds, 40, fits[i]));
  return acoustics;
}

const JudgementModel kModel{.bias = 3, .weights = {1, 0, 0, 0.5, 0, 0, 0, 1, 1, 0, 0, -1, 0}};

double Sum(const Heard& heard) {
  return std::accumulate(heard.commands.begin(), heard.commands.end(), heard.none);
}

TEST(Judgement, SumsToOneAndPrefersWhatFits) {
  const Grammar grammar = YesNoStop();
  const Heard heard = Judge(Sound(grammar, {-5.5, -9, -9, -9}), grammar, kModel);
  EXPECT_NEAR(Sum(heard), 1, 1e-9);
  ASSERT_TRUE(heard.best);
  EXPECT_EQ(*heard.best, 0u);
  EXPECT_GT(heard.commands[0], 0.5);
}

TEST(Judgement, RejectsWhatAnyPhonesFitMuchBetter) {
  const Grammar grammar = YesNoStop();
  const Heard heard = Judge(Sound(grammar, {-14, -15, -15, -15}), grammar, kModel);
  EXPECT_GT(heard.none, 0.9);
}

TEST(Judgement, TakesARivalForEvidenceAgainst) {
  const Grammar grammar = YesNoStop();
  const Heard alone = Judge(Sound(grammar, {-9, -6, -9, -12}), grammar, kModel);
  const Heard with = Judge(Sound(grammar, {-9, -6, -9, -5}), grammar, kModel);
  EXPECT_LT(with.commands[1], alone.commands[1]);
}

TEST(Judgement, OfNothingIsNothing) {
  const Grammar grammar = YesNoStop();
  const Heard heard = Judge({}, grammar, kModel);
  EXPECT_EQ(heard.none, 1);
  EXPECT_FALSE(heard.best);
  EXPECT_TRUE(OptionLikelihoods(heard, grammar, 2).empty());
}

TEST(Judgement, GivesFiniteProbabilitiesForAnySound) {
  const Grammar grammar = YesNoStop();
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> fit(-1000, 10);
  for (int i = 0; i < 2000; ++i) {
    auto acoustics = Sound(grammar, {fit(random), fit(random), fit(random), fit(random)});
    if (i % 3 == 0) acoustics.phrases[random() % 4].reset();
    if (i % 5 == 0) acoustics.free.clear();
    if (i % 7 == 0) acoustics.frames = static_cast<int>(random() % 80);
    const Heard heard = Judge(acoustics, grammar, kModel);
    EXPECT_NEAR(Sum(heard), 1, 1e-9);
    for (const double p : heard.commands) EXPECT_GE(p, 0);
  }
}

TEST(Likelihoods, OfOptionsAreOneForTheBestAndSpreadByWhatIsUnsure) {
  const Grammar grammar = YesNoStop();
  Heard heard;
  heard.commands = {0.8, 0.1, 0, 0};
  heard.none = 0.1;
  const auto likelihoods = OptionLikelihoods(heard, grammar, 2);
  ASSERT_EQ(likelihoods.size(), 2u);
  EXPECT_DOUBLE_EQ(likelihoods[0], 1);
  EXPECT_NEAR(likelihoods[1], 0.15 / 0.85, 1e-9);
}

class TurnTest : public ::testing::Test {
 protected:
  Decision::Kind After(std::vector<double> commands, bool ended = true) {
    Heard heard;
    heard.none = 1 - std::accumulate(commands.begin(), commands.end(), 0.0);
    heard.best = static_cast<size_t>(std::ranges::max_element(commands) - commands.begin());
    heard.commands = std::move(commands);
    decision_ = Decide(heard, YesNoStop(), ended, 2, {});
    return decision_.kind;
  }
  using Kind = Decision::Kind;
  Decision decision_;
};

TEST_F(TurnTest, AnAnswerHasToBeSure) {
  EXPECT_EQ(After({0.9, 0.02, 0.01, 0}), Kind::kCommand);
  EXPECT_EQ(decision_.command.option, 0u);
  EXPECT_EQ(decision_.likelihoods.size(), 2u);
  EXPECT_EQ(After({0.4, 0.02, 0.01, 0}), Kind::kNotUnderstood);
}

TEST_F(TurnTest, StopNeedsLessThanAnythingElseAndNoEnd) {
  EXPECT_EQ(After({0.5, 0, 0.3, 0}), Kind::kStop);
  EXPECT_EQ(After({0, 0, 0.3, 0}, /*ended=*/false), Kind::kStop);
  EXPECT_EQ(After({0.9, 0, 0.05, 0}, /*ended=*/false), Kind::kNothing);
}

TEST_F(TurnTest, ResumeNeedsMore) {
  EXPECT_EQ(After({0, 0, 0, 0.7}), Kind::kNotUnderstood);
  EXPECT_EQ(After({0, 0, 0, 0.9}), Kind::kCommand);
}

TEST_F(TurnTest, OptionsThatMayBeConfusedAreEvidenceTogether) {
  EXPECT_EQ(After({0.45, 0.3, 0.01, 0}), Kind::kCommand);
  EXPECT_NEAR(decision_.likelihoods[1], (0.3 + 0.12) / (0.45 + 0.12), 1e-9);
}

}  // namespace
}  // namespace beckon::ui_bridge::speech
