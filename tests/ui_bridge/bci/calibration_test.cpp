// What known trials say of a decoder.
#include "services/ui_bridge/bci/calibration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "services/ui_bridge/bci/simulated_decoding.h"

namespace beckon::ui_bridge::bci {
namespace {

/// Mean log P(meant) over trials that it has not seen, from an even prior: what honesty maximises.
double Score(const DecoderModel& model, const SimulatedDecoding& decoder, size_t classes,
             std::mt19937_64& random) {
  double score = 0;
  constexpr int kTrials = 4000;
  for (int i = 0; i < kTrials; ++i) {
    const size_t meant = static_cast<size_t>(i) % classes;
    const auto logs = LogLikelihoods(decoder.Draw(meant, random), model);
    double sum = 0;
    for (const double log : logs) sum += std::exp(log);
    score += (logs[meant] - std::log(sum)) / kTrials;
  }
  return score;
}

void Feed(Calibration& calibration, const SimulatedDecoding& decoder, int trials,
          std::mt19937_64& random) {
  for (int i = 0; i < trials; ++i) {
    const size_t meant = static_cast<size_t>(i) % calibration.classes();
    ASSERT_TRUE(calibration.Add({meant, decoder.Draw(meant, random)}));
  }
}

TEST(Calibration, StartsSane) {
  const Calibration fresh(4);
  EXPECT_NEAR(fresh.Accuracy(), 0.7, 1e-12);
  for (size_t m = 0; m < 4; ++m) EXPECT_NEAR(fresh.ExpectedConfusion()[m][m], 0.7, 1e-12);
  EXPECT_NEAR(fresh.Fit().sharpness, 0.8, 1e-9);
  EXPECT_NEAR(fresh.Fit().habit, 0, 1e-9);
}

TEST(Calibration, FindsAnHonestDecoderHonest) {
  std::mt19937_64 random(1);
  Calibration calibration(4);
  Feed(calibration, SimulatedDecoding(4, 0.7), 400, random);
  const auto model = calibration.Fit();
  // Both exponents raise the same evidence; together they should leave it as it is.
  EXPECT_GT(model.sharpness, 0.6);
  EXPECT_LT(model.sharpness + model.habit, 1.6);
  EXPECT_NEAR(calibration.Accuracy(), 0.7, 0.08);
}

TEST(Calibration, TempersADecoderThatIsTooSure) {
  std::mt19937_64 random(2);
  Calibration calibration(4);
  const SimulatedDecoding honest(4, 0.7), too_sure(4, 0.7, 3);
  Feed(calibration, too_sure, 400, random);
  const auto model = calibration.Fit();
  EXPECT_LT(model.sharpness, 0.7);
  std::mt19937_64 one(9), other(9), third(9);
  const double learnt = Score(model, too_sure, 4, one);
  EXPECT_GT(learnt, Score({.sharpness = 1}, too_sure, 4, other) + 0.03);
  EXPECT_GT(learnt, Score({.sharpness = 1}, honest, 4, third) - 0.07);
}

TEST(Calibration, RecoversAKnownConfusion) {
  // Names a class and no more, by this confusion.
  const Confusion truth = {{0.6, 0.35, 0.05}, {0.05, 0.9, 0.05}, {0.1, 0.2, 0.7}};
  CalibrationConfig config;
  config.fading = 1;
  config.most_trials = 3000;
  Calibration calibration(3, config);
  std::mt19937_64 random(3);
  for (int i = 0; i < 3000; ++i) {
    const size_t meant = static_cast<size_t>(i) % 3;
    const double u = Uniform(random);
    const size_t said = u < truth[meant][0] ? 0 : u < truth[meant][0] + truth[meant][1] ? 1 : 2;
    std::vector<double> p(3, 0.0);
    p[said] = 1;
    ASSERT_TRUE(calibration.Add({meant, p}));
  }
  const Confusion found = calibration.ExpectedConfusion();
  for (size_t m = 0; m < 3; ++m)
    for (size_t j = 0; j < 3; ++j) EXPECT_NEAR(found[m][j], truth[m][j], 0.05);
  const auto model = calibration.Fit();
  EXPECT_GT(model.habit, 0.5);
  const auto logs = LogLikelihoods({0, 1, 0}, model);  // 0 is likelier than 2: it is called 1 more
  EXPECT_GT(logs[0], logs[2] + 0.3);
}

TEST(Calibration, FollowsADecoderThatChanges) {
  std::mt19937_64 random(4);
  Calibration calibration(4);
  Feed(calibration, SimulatedDecoding(4, 0.9), 400, random);
  EXPECT_GT(calibration.Accuracy(), 0.84);
  Feed(calibration, SimulatedDecoding(4, 0.5), 400, random);
  EXPECT_LT(calibration.Accuracy(), 0.62);
}

TEST(Calibration, KeepsTheLatestTrialsOnly) {
  Calibration calibration(2, {.most_trials = 10});
  for (int i = 0; i < 25; ++i)
    ASSERT_TRUE(calibration.Add({static_cast<size_t>(i) % 2, {0.5, 0.5}}));
  EXPECT_EQ(calibration.trials().size(), 10u);
  EXPECT_EQ(calibration.trials().back().meant, 0u);
}

TEST(Calibration, RefusesTrialsOfAnotherDecoder) {
  Calibration calibration(3);
  EXPECT_FALSE(calibration.Add({3, {0.2, 0.3, 0.5}}));
  EXPECT_FALSE(calibration.Add({0, {0.5, 0.5}}));
  EXPECT_FALSE(calibration.Add({0, {NAN, 0.5, 0.5}}));
  EXPECT_TRUE(calibration.trials().empty());
}

TEST(Calibration, SurvivesTrialsThatAllSayTheSame) {
  Calibration calibration(3);
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(calibration.Add({1, {1, 0, 0}}));
  const auto model = calibration.Fit();
  EXPECT_TRUE(std::isfinite(model.sharpness) && model.sharpness >= 0);
  EXPECT_TRUE(std::isfinite(model.habit) && model.habit >= 0);
  // A decoder that was always wrong is not believed.
  EXPECT_LT(LogLikelihoods({1, 0, 0}, model)[0] - LogLikelihoods({1, 0, 0}, model)[1], 0.3);
}

}  // namespace
}  // namespace beckon::ui_bridge::bci
