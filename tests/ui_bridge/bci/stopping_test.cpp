// When trials are enough, and when the user wants everything to stop.
#include "services/ui_bridge/bci/stopping.h"

#include <gtest/gtest.h>

#include "services/ui_bridge/bci/evidence.h"
#include "services/ui_bridge/bci/simulated_decoding.h"

namespace beckon::ui_bridge::bci {
namespace {

const StoppingConfig kConfig{
    .threshold = 0.95, .final_threshold = 0.99, .min_repetitions = 2, .max_repetitions = 5};

TEST(Stopping, WaitsForTheThreshold) {
  EXPECT_EQ(ShouldStop(kConfig, {0.94, 0.06}, {}, 3), Verdict::kNotYet);
  EXPECT_EQ(ShouldStop(kConfig, {0.95, 0.05}, {}, 3), Verdict::kSure);
}

TEST(Stopping, WaitsForTheFewestRepetitionsHoweverSure) {
  EXPECT_EQ(ShouldStop(kConfig, {1, 0}, {}, 1), Verdict::kNotYet);
  EXPECT_EQ(ShouldStop(kConfig, {1, 0}, {}, 2), Verdict::kSure);
}

TEST(Stopping, EndsAtTheMostRepetitions) {
  EXPECT_EQ(ShouldStop(kConfig, {0.5, 0.5}, {}, 4), Verdict::kNotYet);
  EXPECT_EQ(ShouldStop(kConfig, {0.5, 0.5}, {}, 5), Verdict::kEnough);
}

TEST(Stopping, WantsToBeSurerOfWhatEndsTheConversation) {
  EXPECT_EQ(ShouldStop(kConfig, {0.97, 0.03}, {true, false}, 3), Verdict::kNotYet);
  EXPECT_EQ(ShouldStop(kConfig, {0.03, 0.97}, {true, false}, 3), Verdict::kSure);
  EXPECT_EQ(ShouldStop(kConfig, {0.99, 0.01}, {true, false}, 3), Verdict::kSure);
}

TEST(StopWatch, OneClearTrialIsEnough) {
  StopWatch watch({.trials_per_false_stop = 50});
  EXPECT_TRUE(watch.Hear({-6, -6, -6, 0}, 3, 2, true));
}

TEST(StopWatch, WhatWasAttendedToBeforeDoesNotDelayIt) {
  StopWatch fresh({.trials_per_false_stop = 1000}), late({.trials_per_false_stop = 1000});
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(late.Hear({0, -3, -3, -3}, 3, 2, true));
  int needed = 1;
  while (!fresh.Hear({-2, -2, -2, 0}, 3, 2, true)) ++needed;
  for (int i = 1; i < needed; ++i) EXPECT_FALSE(late.Hear({-2, -2, -2, 0}, 3, 2, true));
  EXPECT_TRUE(late.Hear({-2, -2, -2, 0}, 3, 2, true));
}

/// Of `what` attended to, trials until it fires; at most `most`.
int TrialsUntilStop(std::optional<size_t> attended, double accuracy, double per_false, int most,
                    std::mt19937_64& random, bool asked) {
  const SimulatedDecoding decoder(4, accuracy);
  StopWatch watch({.trials_per_false_stop = per_false});
  const double gap = decoder.separation() * decoder.separation();
  for (int i = 1; i <= most; ++i)
    if (watch.Hear(LogLikelihoods(decoder.Draw(attended, random), {.sharpness = 1}), 3, gap, asked))
      return i;
  return most;
}

TEST(StopWatch, FalseStopsAreAsRareAsConfigured) {
  std::mt19937_64 random(3);
  for (const auto attended : {std::optional<size_t>(0), std::optional<size_t>()}) {
    double sum = 0;
    for (int i = 0; i < 60; ++i)
      sum += TrialsUntilStop(attended, 0.7, 100, 5000, random, attended.has_value());
    EXPECT_GT(sum / 60, 100);
  }
}

TEST(StopWatch, AWantedStopTakesAFewTrials) {
  std::mt19937_64 random(4);
  for (const bool asked : {true, false}) {
    double sum = 0;
    for (int i = 0; i < 200; ++i) {
      const int trials = TrialsUntilStop(3, 0.7, 100, 1000, random, asked);
      EXPECT_LT(trials, 60);
      sum += trials;
    }
    EXPECT_LT(sum / 200, asked ? 5 : 10);
  }
}

}  // namespace
}  // namespace beckon::ui_bridge::bci
