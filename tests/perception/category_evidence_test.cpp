// What views, examples and the user say of a category together.
#include "services/perception/category_evidence.h"

#include <gtest/gtest.h>

#include <cmath>

namespace beckon::perception {
namespace {

Categorisation Says(std::vector<std::pair<std::string, float>> probabilities) {
  Categorisation said;
  said.probabilities = std::move(probabilities);
  said.confidence = 0.3f;
  said.ask_user = true;
  return said;
}

SeenAt At(double x_m, size_t n_points = 1000) { return {{x_m, 0, 1}, n_points}; }

/// A look that differs from another `kind` far beyond what an example is recognised by.
InstanceLook Look(int kind) {
  InstanceLook look;
  look.height_m = 0.1 * (kind + 1);
  look.width_m = 0.05;
  look.colours[static_cast<size_t>(kind)] = 1;
  look.n_points = 1000;
  return look;
}

float Probability(const Categorisation& said, const std::string& name) {
  for (const auto& [category, p] : said.probabilities) {
    if (category == name) return p;
  }
  return 0;
}

class EvidenceTest : public ::testing::Test {
 protected:
  const Categorisation& Decide() { return evidence.Decide(examples, config); }
  void Add(const SeenAt& at, Categorisation said, int kind = 0) {
    evidence.Add(at, Look(kind), std::move(said), examples, config);
  }
  EvidenceConfig config;
  ToldExamples examples;
  CategoryEvidence evidence;
};

TEST_F(EvidenceTest, OneViewStaysAsItWasCategorised) {
  Categorisation said = Says({{"Mug", 0.6f}, {"Cup", 0.4f}});
  said.confidence = 0.123f;
  said.ask_user = false;
  Add(At(0), said);
  EXPECT_EQ(Decide().probabilities, said.probabilities);
  EXPECT_EQ(Decide().confidence, 0.123f);
  EXPECT_FALSE(Decide().ask_user);
}

TEST_F(EvidenceTest, TwoDifferentViewsThatAgreeAreSurerThanEither) {
  Add(At(0), Says({{"Mug", 0.6f}, {"Cup", 0.4f}}));
  Add(At(0.4), Says({{"Mug", 0.6f}, {"Cup", 0.4f}}));
  EXPECT_GT(Probability(Decide(), "Mug"), 0.62f);
  EXPECT_LT(Probability(Decide(), "Mug"), 0.36f / 0.52f) << "they are not independent";
  EXPECT_NEAR(Probability(Decide(), "Mug") + Probability(Decide(), "Cup"), 1, 1e-5);
}

TEST_F(EvidenceTest, ASureViewOutweighsAnUnsureOne) {
  Add(At(0), Says({{"Cup", 0.55f}, {"Mug", 0.45f}}));
  Add(At(0.4), Says({{"Mug", 0.95f}, {"Cup", 0.05f}}));
  EXPECT_EQ(Decide().probabilities.front().first, "Mug");
  EXPECT_FALSE(Decide().ask_user);
}

TEST_F(EvidenceTest, NearlyTheSameViewSaysNearlyNothingNew) {
  Add(At(0), Says({{"Mug", 0.6f}, {"Cup", 0.4f}}));
  Add(At(0.011), Says({{"Mug", 0.6f}, {"Cup", 0.4f}}));
  EXPECT_NEAR(Probability(Decide(), "Mug"), 0.6, 0.02);
}

TEST_F(EvidenceTest, APartThatIsSeenWeighsLessThanTheWhole) {
  const auto with = [&](size_t n_points) {
    CategoryEvidence of;
    of.Add(At(0, n_points), Look(0), Says({{"Cup", 0.9f}, {"Mug", 0.1f}}), examples, config);
    of.Add(At(0, 1000), Look(0), Says({{"Mug", 0.8f}, {"Cup", 0.2f}}), examples, config);
    return Probability(of.Decide(examples, config), "Mug");
  };
  EXPECT_GT(with(100), with(700));
  EXPECT_GT(with(100), 0.5f);
}

TEST_F(EvidenceTest, AViewIsNewOnlyWhereItDiffersFromAllThatWereTaken) {
  EXPECT_TRUE(evidence.IsNew(At(0), config));
  Add(At(0), Says({{"Mug", 1.0f}}));
  EXPECT_FALSE(evidence.IsNew(At(0.005, 1100), config)) << "noise";
  EXPECT_TRUE(evidence.IsNew(At(0.02), config));
  EXPECT_TRUE(evidence.IsNew(At(0, 1300), config));
  for (const double x_m : {0.08, 0.16, 0.08}) Add(At(x_m), Says({{"Mug", 1.0f}}));
  EXPECT_FALSE(evidence.IsNew(At(0.005), config)) << "it was there before";
  Add(At(0.5), Says({{"Mug", 1.0f}}));
  EXPECT_TRUE(evidence.IsNew(At(0.005), config)) << "what jumps there may be another";
}

TEST_F(EvidenceTest, APartIsNoWholeViewHoweverNearItIs) {
  Add(At(0, 1000), Says({{"Mug", 1.0f}}));
  EXPECT_TRUE(evidence.IsWhole(At(0.2, 900)));
  EXPECT_FALSE(evidence.IsWhole(At(0.2, 500)));
  EXPECT_FALSE(evidence.IsWhole({{0, 0, 0.5}, 1000})) << "a quarter of it, from half the distance";
}

TEST_F(EvidenceTest, TheNumberOfViewsIsBounded) {
  for (int i = 0; i < 100; ++i) Add(At(0.05 * i), Says({{"Mug", 0.6f}, {"Cup", 0.4f}}));
  EXPECT_EQ(evidence.n_views(), config.most_views);
  EXPECT_LT(Probability(Decide(), "Mug"), 0.95f);
}

TEST_F(EvidenceTest, WhatTheUserSaysIsNearlyCertainAndNotAskedAgain) {
  Add(At(0), Says({{"Mug", 0.6f}, {"Cup", 0.3f}, {"Tin", 0.1f}}));
  config.ask_at_or_below = 1;  // asks about everything
  evidence.Tell({"l", "Tin"});
  EXPECT_EQ(Decide().probabilities.front().first, "Tin");
  EXPECT_GT(Decide().probabilities.front().second, 0.9f);
  EXPECT_LT(Decide().probabilities.front().second, 1.0f);
  EXPECT_FALSE(Decide().ask_user);
  EXPECT_GT(Probability(Decide(), "Mug"), Probability(Decide(), "Cup"));
  evidence.Retract("another");
  EXPECT_FALSE(Decide().ask_user);
  evidence.Retract("l");
  EXPECT_TRUE(Decide().ask_user);
  EXPECT_EQ(Decide().probabilities.front().first, "Mug");
}

TEST_F(EvidenceTest, ACategoryThatTheCategoriserLacksCanBeSaid) {
  Add(At(0), Says({{"Mug", 0.6f}, {"Cup", 0.4f}}));
  evidence.Tell({"l", "Unknown"});
  EXPECT_EQ(Decide().probabilities.front().first, "Unknown");
  EXPECT_EQ(Decide().probabilities.size(), 3u);
}

TEST_F(EvidenceTest, WithoutACategoriserTheUsersWordStandsAlone) {
  Add(At(0), {});
  EXPECT_TRUE(Decide().probabilities.empty());
  EXPECT_TRUE(Decide().ask_user);
  evidence.Tell({"l", "Mug"});
  EXPECT_EQ(Decide().probabilities.front().first, "Mug");
  EXPECT_FALSE(Decide().ask_user);
}

TEST_F(EvidenceTest, AnObjectThatJumpsAndLooksOtherwiseIsAnother) {
  Add(At(0), Says({{"Mug", 0.6f}, {"Cup", 0.4f}}));
  evidence.Tell({"l", "Tin"});
  examples.Add({"l", "Tin", Look(0)});
  Add(At(0.05), Says({{"Mug", 0.6f}, {"Cup", 0.4f}}), 1);
  EXPECT_TRUE(evidence.told()) << "it was watched all the way";
  Add(At(0.5), Says({{"Mug", 0.6f}, {"Cup", 0.4f}}), 0);
  EXPECT_TRUE(evidence.told()) << "it looks as it did";
  Add(At(0), Says({{"Mug", 0.6f}, {"Cup", 0.4f}}), 1);
  EXPECT_FALSE(evidence.told());
}

TEST_F(EvidenceTest, AnExampleAlikeIsEvidenceAndNoVerdict) {
  Add(At(0), Says({{"Mug", 0.5f}, {"Cup", 0.3f}, {"Tin", 0.2f}}));
  examples.Add({"l", "Tin", Look(0)});
  EXPECT_EQ(Decide().probabilities.front().first, "Tin");
  EXPECT_FALSE(Decide().ask_user);
  CategoryEvidence sure;
  sure.Add(At(0), Look(0), Says({{"Mug", 0.9999f}, {"Tin", 0.0001f}}), examples, config);
  EXPECT_EQ(sure.Decide(examples, config).probabilities.front().first, "Mug");
  examples.Remove("l");
  EXPECT_EQ(Decide().probabilities.front().first, "Mug");
}

TEST_F(EvidenceTest, OneOfManyExamplesSaysLessForItMayLookAlikeByChance) {
  Add(At(0), Says({{"Mug", 0.5f}, {"Cup", 0.3f}, {"Tin", 0.2f}}));
  examples.Add({"l", "Tin", Look(0)});
  const float of_one = Probability(Decide(), "Tin");
  for (int i = 0; i < 100; ++i) examples.Add({std::to_string(i), "Tub", Look(5)});
  EXPECT_LT(Probability(Decide(), "Tin"), of_one);
  EXPECT_GT(Probability(Decide(), "Tin"), 0.2f);
}

TEST_F(EvidenceTest, AnExampleOfAnotherLookSaysNothing) {
  Add(At(0), Says({{"Mug", 0.5f}, {"Cup", 0.5f}}));
  examples.Add({"l", "Tin", Look(1)});
  EXPECT_EQ(Probability(Decide(), "Tin"), 0);
  EXPECT_EQ(Probability(Decide(), "Mug"), 0.5f);
}

TEST(LikelihoodRatio, FallsWithTheDifferenceAndIsBounded) {
  EXPECT_EQ(LogLikelihoodRatio(kRecognisedBelow), 0);
  EXPECT_EQ(LogLikelihoodRatio(std::nan("")), 0);
  EXPECT_GT(LogLikelihoodRatio(kRecognisedBelow - 0.01), std::log(5.0));
  EXPECT_GT(LogLikelihoodRatio(0.5), LogLikelihoodRatio(2));
  EXPECT_LE(LogLikelihoodRatio(0), std::log(1000.0));
}

}  // namespace
}  // namespace beckon::perception
