// Which cues have a say, and what becomes of a view that some of them cannot see.
#include <gmock/gmock.h>

#include "services/perception/categoriser.h"
#include "services/perception/cue_interface.h"
#include "services/perception/model.h"
#include "services/perception/model_file.h"
#include "tests/perception/categoriser_trained.h"

namespace beckon::perception {
namespace {

using testing::HasSubstr;
using Names = std::vector<std::string>;

ShapeView SomeCan() {
  std::mt19937 random(5);
  return RenderCategory("Can", random);
}

Names NamesOf(const Categorisation& result) {
  Names names;
  for (const auto& cue : result.cues) names.push_back(cue.name);
  return names;
}

void ExpectDistribution(const Categorisation& result) {
  EXPECT_EQ(result.reason, "");
  ASSERT_EQ(result.probabilities.size(), 3U);
  float sum = 0;
  for (const auto& [name, p] : result.probabilities) sum += p;
  EXPECT_NEAR(sum, 1, 1e-4);
  EXPECT_TRUE(std::isfinite(result.confidence));
}

TEST(CueNames, StandForSetsInTheModelsOrder) {
  const Names known = {"sift", "hog", "fpfh", "shape"};
  EXPECT_EQ(*ParseCueNames("all", known), known);
  EXPECT_EQ(*ParseCueNames("dissertation", known), (Names{"sift", "hog", "fpfh"}));
  EXPECT_EQ(*ParseCueNames("shape,hog", known), (Names{"hog", "shape"}));
  for (const char* wrong : {"smell", "", ",", "shape,smell", "All"}) {
    const auto names = ParseCueNames(wrong, known);
    ASSERT_FALSE(names) << wrong;
    EXPECT_THAT(names.error().message, HasSubstr("sift, hog, fpfh, shape"));
  }
  EXPECT_FALSE(ParseCueNames("dissertation", {"shape"}));
}

TEST(CueSets, TheDissertationsHaveADeciderOfTheirOwn) {
  const Model& model = TrainedOnShapes().model;
  const Decider* decider = FindDecider(model, {0, 1, 2});
  ASSERT_NE(decider, nullptr);
  EXPECT_TRUE(decider->weights.empty());
  EXPECT_EQ(decider->svm.dimension(), 9) << "3k confidences feed it";
  Categoriser categoriser(model);
  ASSERT_TRUE(categoriser.UseCues("dissertation"));
  EXPECT_EQ(categoriser.threshold(), decider->threshold);
  const ShapeView can = SomeCan();
  const Categorisation result = categoriser.Categorise(can.view());
  ExpectDistribution(result);
  EXPECT_EQ(NamesOf(result), (Names{"sift", "hog", "fpfh"}));
}

TEST(CueSets, ASingleCueDecidesAlone) {
  Categoriser categoriser(TrainedOnShapes().model);
  ASSERT_TRUE(categoriser.UseCues("shape"));
  const ShapeView can = SomeCan();
  const Categorisation result = categoriser.Categorise(can.view());
  ExpectDistribution(result);
  ASSERT_EQ(NamesOf(result), Names{"shape"});
  const auto& said = result.cues[0].probabilities;
  const auto best = std::max_element(said.begin(), said.end()) - said.begin();
  EXPECT_EQ(result.probabilities[0].first, categoriser.categories()[static_cast<size_t>(best)]);
}

TEST(CueSets, OtherSetsTakeTheRestAsNotSeen) {
  Categoriser categoriser(TrainedOnShapes().model);
  ASSERT_TRUE(categoriser.UseCues("shape,depth_hog"));
  const ShapeView can = SomeCan();
  const Categorisation result = categoriser.Categorise(can.view());
  ExpectDistribution(result);
  EXPECT_EQ(result.probabilities[0].first, "Can");
  const Status wrong = categoriser.UseCues("smell");
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().message, HasSubstr("smell"));
  ASSERT_TRUE(categoriser.UseCues("all"));
  EXPECT_EQ(categoriser.Categorise(can.view()).probabilities,
            Categoriser(TrainedOnShapes().model).Categorise(can.view()).probabilities);
}

TEST(CueSets, AModelOfSomeCuesHoldsNoOthers) {
  TrainConfig config = SmallTraining();
  config.cues = "dissertation";
  const auto three = TrainOnShapes(config);
  ASSERT_TRUE(three) << three.error().message;
  EXPECT_EQ(three->model.cues.size(), 3U);
  EXPECT_TRUE(three->model.deciders.front().weights.empty());
  EXPECT_TRUE(Categoriser(three->model).UseCues("dissertation"));
  config.cues = "shape";
  const auto one = TrainOnShapes(config);
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_EQ(one->model.deciders.size(), 1U);
  EXPECT_FALSE(Categoriser(one->model).UseCues("dissertation"));
  const auto again = ParseModel(SerialiseModel(one->model), "m");
  ASSERT_TRUE(again) << again.error().message;
  config.cues = "smell";
  EXPECT_FALSE(TrainOnShapes(config));
}

TEST(MissingCue, IsReplacedByTheOthersMean) {
  std::vector<std::vector<float>> by_cue = {{0.5F, 0.5F}, {}, {0.9F, 0.1F}};
  ASSERT_TRUE(FillMissing({}, by_cue));
  // sqrt(.51 .91) : sqrt(.51 .11), with a doubt of .01 each
  EXPECT_NEAR(by_cue[1][0] / by_cue[1][1], std::sqrt(0.91 / 0.11), 1e-3);
  EXPECT_NEAR(by_cue[1][0] + by_cue[1][1], 1, 1e-5);
  // Cues that count for nothing add nothing to what is filled in.
  by_cue = {{0.5F, 0.5F}, {}, {0.9F, 0.1F}};
  ASSERT_TRUE(FillMissing({0, 1, 2}, by_cue));
  EXPECT_NEAR(by_cue[1][0] / by_cue[1][1], 0.91 / 0.11, 1e-2);
  std::vector<std::vector<float>> none = {{}, {}};
  EXPECT_FALSE(FillMissing({}, none));
}

TEST(MissingCue, AViewWithoutColourIsStillRecognised) {
  const Categoriser categoriser(TrainedOnShapes().model);
  std::mt19937 random(99);
  int right = 0;
  for (int i = 0; i < 9; ++i) {
    const std::string category = Names{"Bowl", "Box", "Can"}[static_cast<size_t>(i % 3)];
    ShapeView view = RenderCategory(category, random);
    for (const bool black : {false, true}) {
      view.image.colour.assign(black ? view.image.depth_m.size() : 0, Rgb{});
      const Categorisation result = categoriser.Categorise(view.view());
      ExpectDistribution(result);
      right += result.probabilities[0].first == category;
      for (const auto& cue : result.cues) {
        EXPECT_EQ(cue.probabilities.empty(), cue.name == "sift" || cue.name == "hog") << cue.name;
      }
    }
  }
  EXPECT_GE(right, 14) << "of 18";
}

TEST(MissingCue, WhereNoneSeesAnythingTheAnswerSaysSo) {
  Categoriser categoriser(TrainedOnShapes().model);
  ASSERT_TRUE(categoriser.UseCues("sift"));
  ShapeView view = SomeCan();
  view.image.colour.clear();
  const Categorisation result = categoriser.Categorise(view.view());
  EXPECT_TRUE(result.probabilities.empty());
  EXPECT_TRUE(result.ask_user);
  EXPECT_THAT(result.reason, HasSubstr("colour"));
}

TEST(MissingCue, TrainingWithoutColourLeavesItOut) {
  auto views = RenderViews({"Bowl", "Box", "Can"}, 8, 11);
  for (LabelledView& view : views) view.shape.image.colour.clear();
  const auto outcome = TrainOn(SmallTraining(), views);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->model.cues.size(), MakeCues().size() - 2);
  ASSERT_EQ(outcome->notes.size(), 2U);
  EXPECT_THAT(outcome->notes[0], HasSubstr("sift"));
}

TEST(MissingCue, TrainingWithSomeViewsWithoutColourKeepsIt) {
  auto views = RenderViews({"Bowl", "Box", "Can"}, 8, 11);
  for (size_t i = 0; i < views.size(); i += 4) views[i].shape.image.colour.clear();
  const auto outcome = TrainOn(SmallTraining(), views);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->model.cues.size(), MakeCues().size());
  EXPECT_TRUE(outcome->notes.empty());
  for (const auto& held_out : outcome->held_out.front()) {
    EXPECT_EQ(held_out.probabilities.size(), 3U);
  }
}

TEST(OddViews, WithoutATableAreStillRecognised) {
  const Categoriser categoriser(TrainedOnShapes().model);
  const ShapeView can = SomeCan();
  const Categorisation result = categoriser.Categorise({can.image, can.pixels});
  ExpectDistribution(result);
  EXPECT_EQ(result.probabilities[0].first, "Can");
}

TEST(OddViews, OfThirtyPointsHaveAnAnswer) {
  const Categoriser categoriser(TrainedOnShapes().model);
  const ShapeView can = SomeCan();
  const std::vector<uint32_t> few(can.pixels.begin(), can.pixels.begin() + 30);
  ExpectDistribution(categoriser.Categorise({can.image, few, can.table_C}));
  const std::vector<uint32_t> fewer(can.pixels.begin(), can.pixels.begin() + 19);
  const Categorisation none = categoriser.Categorise({can.image, fewer, can.table_C});
  EXPECT_TRUE(none.probabilities.empty());
  EXPECT_THAT(none.reason, HasSubstr("found 19"));
}

TEST(OddViews, CutAtTheImagesBorderHaveAnAnswer) {
  const Categoriser categoriser(TrainedOnShapes().model);
  const ShapeView can = SomeCan();
  ShapeView half;
  half.image = can.image;
  half.image.width = 100;
  half.image.depth_m.clear();
  half.image.colour.clear();
  for (const uint32_t pixel : can.pixels) {
    const uint32_t u = pixel % 200, v = pixel / 200;
    if (u < 100) half.pixels.push_back(v * 100 + u);
  }
  for (size_t i = 0; i < can.image.depth_m.size(); ++i) {
    if (i % 200 >= 100) continue;
    half.image.depth_m.push_back(can.image.depth_m[i]);
    half.image.colour.push_back(can.image.colour[i]);
  }
  ASSERT_GT(half.pixels.size(), 500U);
  ExpectDistribution(categoriser.Categorise({half.image, half.pixels, can.table_C}));
}

TEST(OddViews, LargerThanAMetreAreNoObject) {
  const Categoriser categoriser(TrainedOnShapes().model);
  ShapeView wall;
  wall.image.width = 60, wall.image.height = 60;
  wall.image.intrinsics = {50, 50, 29.5, 29.5};
  wall.image.depth_m.assign(3600, 1.5F);
  for (uint32_t i = 0; i < 3600; ++i) wall.pixels.push_back(i);
  const Categorisation result = categoriser.Categorise({wall.image, wall.pixels});
  EXPECT_TRUE(result.probabilities.empty());
  EXPECT_TRUE(result.ask_user);
  EXPECT_EQ(result.confidence, 0);
  EXPECT_THAT(result.reason, HasSubstr("at most 1 m"));
}

}  // namespace
}  // namespace beckon::perception
