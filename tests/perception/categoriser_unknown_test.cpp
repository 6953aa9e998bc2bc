// Things that are none of the categories.
#include <gtest/gtest.h>

#include "services/perception/categoriser.h"
#include "services/perception/model.h"
#include "services/perception/train_figures.h"
#include "tests/perception/categoriser_trained.h"

namespace beckon::perception {
namespace {

/// Cans count as Unknown.
const TrainOutcome& WithUnknown() {
  static const TrainOutcome outcome = [] {
    auto views = RenderViews({"Bowl", "Box", "Can"}, 8, 11);
    for (LabelledView& view : views) {
      if (view.category == "Can") view.category = kUnknown;
    }
    return *TrainOn(SmallTraining(), views);
  }();
  return outcome;
}

TEST(Unknown, IsSaidOfWhatLooksLikeIt) {
  Categoriser categoriser(WithUnknown().model);
  categoriser.set_threshold(0);
  std::mt19937 random(99);
  int right = 0;
  for (int i = 0; i < 6; ++i) {
    const ShapeView can = RenderCategory("Can", random);
    const Categorisation result = categoriser.Categorise(can.view());
    right += result.probabilities.at(0).first == kUnknown && !result.ask_user;
  }
  EXPECT_GE(right, 5) << "of 6";
}

TEST(Unknown, IsAsProbableAsItsPriorSays) {
  Model model = WithUnknown().model;
  model.deciders.front().temperature = 8;  // else as good as certain
  Categoriser categoriser(std::move(model));
  std::mt19937 random(5);
  const ShapeView can = RenderCategory("Can", random);
  const auto probability = [&](float prior) {
    categoriser.set_unknown_prior(prior);
    float sum = 0, unknown = 0;
    for (const auto& [name, p] : categoriser.Categorise(can.view()).probabilities) {
      sum += p;
      if (name == kUnknown) unknown = p;
    }
    EXPECT_NEAR(sum, 1, 1e-4);
    return unknown;
  };
  const float even = probability(1), rare = probability(0.1F), frequent = probability(10);
  EXPECT_LT(rare, even);
  EXPECT_GT(frequent, even);
  // Odds scale with the prior.
  EXPECT_NEAR(rare / (1 - rare), 0.1F * even / (1 - even), 0.02F * even / (1 - even));
}

TEST(Unknown, PriorIsNoMatterToAModelWithoutIt) {
  std::vector<float> p = {0.25F, 0.75F};
  ApplyUnknownPrior({"Bowl", "Box"}, 10, p);
  EXPECT_EQ(p, (std::vector<float>{0.25F, 0.75F}));
}

TEST(Unknown, IsCountedApartFromTheKnown) {
  const std::vector<std::string> categories = {"Box", "Can", "Unknown"};
  // label, predicted, top 3, confidence, probability
  const std::vector<Judgement> judgements = {
      {0, 0, true, 0.9F, 0.9F},  {0, 1, true, 0.3F, 0.5F},  // known: one right
      {1, 2, true, 0.9F, 0.9F},  {1, 1, true, 0.9F, 0.9F},  // known: one taken for strange
      {2, 2, true, 0.9F, 0.9F},                             // strange and said so
      {2, 0, true, 0.9F, 0.9F},                             // strange, named unasked
      {2, 0, true, 0.4F, 0.5F},                             // strange, asked about
      {3, 1, false, 0.8F, 0.8F},                            // of a category nobody knows
  };
  const Figures f = FiguresOf(judgements, categories, 0.5F);
  EXPECT_EQ(f.views, 4U);
  EXPECT_DOUBLE_EQ(f.accuracy, 0.5);
  EXPECT_DOUBLE_EQ(f.macro_recall, 0.5);
  EXPECT_DOUBLE_EQ(f.asked, 0.25);
  EXPECT_EQ(f.unknown_views, 4U);
  EXPECT_DOUBLE_EQ(f.unknown_named, 0.5);
}

TEST(Figures, CalibrationErrorHasItsKnownValues) {
  std::vector<Judgement> honest, boastful;
  for (int i = 0; i < 1000; ++i) {
    honest.push_back({0, i % 10 < 7 ? 0 : 1, true, 0.5F, 0.7F});
    boastful.push_back({0, i % 10 < 7 ? 0 : 1, true, 0.9F, 0.95F});
  }
  EXPECT_NEAR(CalibrationError(honest), 0, 1e-6);
  EXPECT_NEAR(CalibrationError(boastful), 0.25, 1e-6);
  EXPECT_EQ(CalibrationError({}), 0);
  const auto bins = Reliability(honest);
  ASSERT_EQ(bins.size(), 10U);
  for (const ReliabilityBin& bin : bins) EXPECT_EQ(bin.views, 100U);
  EXPECT_EQ(Reliability({honest[0], honest[1]}).size(), 2U);
}

}  // namespace
}  // namespace beckon::perception
