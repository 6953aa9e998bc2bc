// What the categoriser says of views, good and bad.
#include "services/perception/categoriser.h"

#include <gmock/gmock.h>

#include "services/perception/categoriser_confidence.h"
#include "services/perception/cue_interface.h"
#include "services/perception/model.h"
#include "tests/perception/categoriser_trained.h"

namespace beckon::perception {
namespace {

TEST(RenyiConfidence, HasItsKnownValues) {
  EXPECT_FLOAT_EQ(RenyiConfidence({0.25F, 0.25F, 0.25F, 0.25F}), 0);
  EXPECT_FLOAT_EQ(RenyiConfidence({0, 1, 0, 0}), 1);
  // sum of squares 1/2: H2 = 1 bit of log2 4 = 2
  EXPECT_FLOAT_EQ(RenyiConfidence({0.5F, 0.5F, 0, 0}), 0.5F);
  // 0.64 + 0.04 = 0.68; 1 + log2 0.68
  EXPECT_NEAR(RenyiConfidence({0.8F, 0.2F}), 0.443607, 1e-5);
  EXPECT_EQ(RenyiConfidence({}), 0);
  EXPECT_EQ(RenyiConfidence({1}), 0);
}

TEST(Categoriser, RecognisesShapesItNeverSaw) {
  const Categoriser categoriser(TrainedOnShapes().model);
  std::mt19937 random(99);
  int right = 0;
  for (const std::string category : {"Bowl", "Box", "Can"}) {
    for (int i = 0; i < 4; ++i) {
      const ShapeView view = RenderCategory(category, random);
      const Categorisation result = categoriser.Categorise(view.view());
      right += result.probabilities.at(0).first == category;
    }
  }
  EXPECT_GE(right, 10) << "of 12";
}

TEST(Categoriser, GivesSortedProbabilitiesThatSumToOne) {
  const Categoriser categoriser(TrainedOnShapes().model);
  std::mt19937 random(5);
  const ShapeView view = RenderCategory("Can", random);
  const Categorisation result = categoriser.Categorise(view.view());
  ASSERT_EQ(result.probabilities.size(), 3U);
  float sum = 0;
  for (const auto& [category, p] : result.probabilities) sum += p;
  EXPECT_NEAR(sum, 1, 1e-5);
  EXPECT_GE(result.probabilities[0].second, result.probabilities[1].second);
  EXPECT_GE(result.probabilities[1].second, result.probabilities[2].second);
  EXPECT_EQ(result.cues.size(), MakeCues().size());
  EXPECT_GE(result.confidence, 0);
  EXPECT_LE(result.confidence, 1);
}

TEST(Categoriser, AsksAtOrBelowTheThreshold) {
  Categoriser categoriser(TrainedOnShapes().model);
  std::mt19937 random(5);
  const ShapeView view = RenderCategory("Box", random);
  const float confidence = categoriser.Categorise(view.view()).confidence;
  categoriser.set_threshold(confidence);
  EXPECT_TRUE(categoriser.Categorise(view.view()).ask_user);
  categoriser.set_threshold(confidence - 1e-4F);
  EXPECT_FALSE(categoriser.Categorise(view.view()).ask_user);
}

TEST(Categoriser, SaysTheSameOfTheWholeImageAsOfTheCrop) {
  const Categoriser categoriser(TrainedOnShapes().model);
  std::mt19937 random(5);
  const ShapeView crop = RenderCategory("Can", random);
  constexpr int kU = 200, kV = 130;
  ShapeView whole;
  whole.image.width = 640, whole.image.height = 480;
  whole.image.intrinsics = crop.image.intrinsics;
  whole.image.intrinsics.cx += kU;
  whole.image.intrinsics.cy += kV;
  whole.image.depth_m.assign(640 * 480, 1.5F);
  whole.image.colour.assign(640 * 480, Rgb{200, 30, 30});
  for (int v = 0; v < crop.image.height; ++v) {
    for (int u = 0; u < crop.image.width; ++u) {
      const size_t to = whole.image.Index(u + kU, v + kV);
      whole.image.depth_m[to] = crop.image.depth_m[crop.image.Index(u, v)];
      whole.image.colour[to] = crop.image.colour[crop.image.Index(u, v)];
    }
  }
  for (const uint32_t pixel : crop.pixels) {
    whole.pixels.push_back(static_cast<uint32_t>(
        whole.image.Index(static_cast<int>(pixel) % 200 + kU, static_cast<int>(pixel) / 200 + kV)));
  }
  const auto a = categoriser.Categorise({crop.image, crop.pixels, crop.table_C});
  const auto b = categoriser.Categorise({whole.image, whole.pixels, crop.table_C});
  ASSERT_EQ(a.probabilities.size(), b.probabilities.size());
  EXPECT_EQ(a.probabilities[0].first, b.probabilities[0].first);
  EXPECT_NEAR(a.probabilities[0].second, b.probabilities[0].second, 0.02);
}

TEST(Categoriser, MissingDepthPixelsInTheMaskDoNoHarm) {
  const Categoriser categoriser(TrainedOnShapes().model);
  std::mt19937 random(5);
  ShapeView view = RenderCategory("Box", random);
  for (size_t i = 0; i < view.pixels.size(); i += 3) view.image.depth_m[view.pixels[i]] = 0;
  const auto result = categoriser.Categorise(view.view());
  ASSERT_FALSE(result.probabilities.empty());
  EXPECT_EQ(result.probabilities[0].first, "Box");
}

/// Views that are hardly views: probabilities stay finite, or there are none.
class OddView : public testing::TestWithParam<int> {
 protected:
  static void ExpectFinite(const Categorisation& result) {
    for (const auto& [category, p] : result.probabilities) EXPECT_TRUE(std::isfinite(p));
    EXPECT_TRUE(std::isfinite(result.confidence));
    for (const auto& cue : result.cues) {
      for (const float p : cue.probabilities) EXPECT_TRUE(std::isfinite(p)) << cue.name;
    }
  }
};

TEST_P(OddView, OfFewPointsIsFiniteWithoutColourAndTable) {
  const Categoriser categoriser(TrainedOnShapes().model);
  std::mt19937 random(5);
  ShapeView view = RenderCategory("Can", random);
  view.image.colour.clear();
  std::vector<uint32_t> few(view.pixels.begin(),
                            view.pixels.begin() + std::min<int64_t>(GetParam(), 1000));
  const Categorisation result = categoriser.Categorise({view.image, few});
  ExpectFinite(result);
  EXPECT_EQ(result.probabilities.empty(), GetParam() < Categoriser::kMinPoints);
}
INSTANTIATE_TEST_SUITE_P(Points, OddView, testing::Values(0, 1, 19, 20, 30, 100));

TEST_F(OddView, AllAtOneDepthOrInOneColumnIsFinite) {
  const Categoriser categoriser(TrainedOnShapes().model);
  RgbdImage image;
  image.width = 60, image.height = 60;
  image.depth_m.assign(3600, 0.7F);
  std::vector<uint32_t> column, all;
  for (uint32_t i = 0; i < 3600; ++i) {
    all.push_back(i);
    if (i % 60 == 0) column.push_back(i);
  }
  ExpectFinite(categoriser.Categorise({image, all}));
  ExpectFinite(categoriser.Categorise({image, column}));
  ExpectFinite(categoriser.Categorise({image, all, Plane{Eigen::Vector3d(0, 0, -1), 1}}));
}

TEST_F(OddView, WithPixelsOutsideTheImageIgnoresThem) {
  const Categoriser categoriser(TrainedOnShapes().model);
  std::mt19937 random(5);
  ShapeView view = RenderCategory("Can", random);
  const auto before = categoriser.Categorise(view.view());
  view.pixels.push_back(4000000000U);
  const auto after = categoriser.Categorise(view.view());
  EXPECT_EQ(before.probabilities, after.probabilities);
}

TEST(Cues, HaveTheDimensionTheyName) {
  std::mt19937 random(5);
  const ShapeView view = RenderCategory("Bowl", random);
  const ObjectView object = view.view();
  const CueView prepared = MakeCueView(object);
  for (const auto& cue : MakeCues()) {
    const Descriptors descriptors = cue->Describe(prepared);
    EXPECT_EQ(descriptors.cols(), cue->dimension()) << cue->name();
    EXPECT_TRUE(descriptors.allFinite()) << cue->name();
    if (cue->encoding() != Encoding::kBag) {
      EXPECT_EQ(descriptors.rows(), 1) << cue->name();
    }
  }
}

TEST(CueView, StandsOnTheTable) {
  std::mt19937 random(5);
  const ShapeView view = RenderShape(CanShape(0.035, 0.12), random);
  const ObjectView object = view.view();
  const CueView prepared = MakeCueView(object);
  EXPECT_LE(prepared.size(), CueView::kMaxPoints);
  EXPECT_NEAR(prepared.points_T.row(2).maxCoeff(), 0.12, 0.006);
  EXPECT_NEAR(prepared.points_T.row(0).maxCoeff() - prepared.points_T.row(0).minCoeff(), 0.07,
              0.006);
  int up = 0, sideways = 0;
  for (int i = 0; i < prepared.size(); ++i) {
    const Eigen::Vector3f n = prepared.normals_T.col(i);
    EXPECT_NEAR(n.norm(), 1, 1e-3);
    up += n.z() > 0.9F;
    sideways += std::abs(n.z()) < 0.3F;
  }
  EXPECT_GT(up, prepared.size() / 10);       // the lid
  EXPECT_GT(sideways, prepared.size() / 2);  // the side
}

}  // namespace
}  // namespace beckon::perception
