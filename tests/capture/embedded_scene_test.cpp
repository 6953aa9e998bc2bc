// The embedded scene: the same bytes from the same seed, and a ground truth that is true.
#include "services/capture/embedded_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "services/capture/embedded_model.h"
#include "services/capture/embedded_object_view.h"

namespace beckon::capture {
namespace {

TEST(EmbeddedSceneTest, SameSeedSameBytes) {
  const EmbeddedFrame a = RenderEmbeddedScene(11), b = RenderEmbeddedScene(11);
  EXPECT_EQ(a.image.depth_m, b.image.depth_m);
  EXPECT_EQ(a.image.colour, b.image.colour);
  EXPECT_EQ(a.labels, b.labels);
  const EmbeddedFrame c = RenderEmbeddedScene(12);
  EXPECT_NE(a.image.depth_m, c.image.depth_m);
  EXPECT_NE(FrameSeed(1, 0), FrameSeed(1, 1));
  EXPECT_NE(FrameSeed(1, 0), FrameSeed(2, 0));
}

class EmbeddedSceneSeeds : public ::testing::TestWithParam<uint64_t> {};

TEST_P(EmbeddedSceneSeeds, KnowsWhatItShows) {
  const EmbeddedFrame frame = RenderEmbeddedScene(GetParam());
  const SceneDescription& truth = frame.description;
  EXPECT_EQ(frame.image.width, 640);
  EXPECT_EQ(frame.image.height, 480);
  ASSERT_EQ(frame.labels.size(), 640u * 480u);
  EXPECT_TRUE(truth.known);
  EXPECT_GE(truth.objects.size(), 3u);
  EXPECT_LE(truth.objects.size(), 8u);
  for (const DescribedObject& object : truth.objects) {
    EXPECT_NE(std::find(kCategories.begin(), kCategories.end(), object.category),
              kCategories.end());
    EXPECT_GE(object.visible_points, 300);
    EXPECT_EQ(object.visible_points,
              std::count(frame.labels.begin(), frame.labels.end(), object.label));
    ASSERT_TRUE(object.X_CO && object.X_WO);
    EXPECT_LT((object.centroid_C - object.X_CO->translation()).norm(), 0.17);
    const Pose X_WC = WorldFromTable(*truth.table_C);
    EXPECT_LT((X_WC * object.X_CO->translation() - object.X_WO->translation()).norm(), 1e-9);
    const double height = truth.table_C->Distance(object.centroid_C);
    EXPECT_GT(height, 0.0);
    EXPECT_LT(height, 0.3);
  }
}

TEST_P(EmbeddedSceneSeeds, TableLiesWhereItSays) {
  const EmbeddedFrame frame = RenderEmbeddedScene(GetParam());
  // Points without a label are on the table, or on floor and wall well below or behind it.
  double sum = 0;
  int n = 0;
  for (int v = 240; v < 480; v += 4) {
    for (int u = 0; u < 640; u += 4) {
      if (!frame.image.HasDepth(u, v) || frame.labels[frame.image.Index(u, v)] != 0) continue;
      const double d = frame.description.table_C->Distance(frame.image.Point(u, v));
      if (d < -0.015) continue;  // the table's front, the floor
      EXPECT_LT(d, 0.02);
      sum += d;
      ++n;
    }
  }
  ASSERT_GT(n, 1000);
  EXPECT_LT(std::abs(sum / n), 0.0015);
}

INSTANTIATE_TEST_SUITE_P(Seeds, EmbeddedSceneSeeds, ::testing::Values(1, 2, 3, 17, 100, 4711));

TEST(EmbeddedSceneTest, ObjectsDoNotTouch) {
  for (uint64_t seed : {21, 22, 23}) {
    const EmbeddedFrame frame = RenderEmbeddedScene(seed);
    const auto& objects = frame.description.objects;
    for (size_t i = 0; i < objects.size(); ++i) {
      for (size_t j = i + 1; j < objects.size(); ++j) {
        const Eigen::Vector3d apart =
            objects[i].X_WO->translation() - objects[j].X_WO->translation();
        EXPECT_GT(apart.head<2>().norm(), 0.03);
      }
    }
  }
}

TEST(EmbeddedSceneTest, AllCategoriesComeUp) {
  std::set<std::string> seen;
  for (uint64_t seed = 0; seed < 30 && seen.size() < kCategories.size(); ++seed) {
    for (const auto& object : RenderEmbeddedScene(seed).description.objects)
      seen.insert(object.category);
  }
  EXPECT_EQ(seen.size(), kCategories.size());
}

TEST(ObjectViewTest, ShowsTheObjectWithItsMask) {
  int hidden = 0, without_up = 0;
  constexpr int kViews = 66;
  for (int i = 0; i < kViews; ++i) {
    Random random(static_cast<uint64_t>(i));
    const Model model = MakeModel(static_cast<size_t>(i) % kCategories.size(), random);
    const auto rendered = RenderObjectView(model, i % 2 == 0, random);
    ASSERT_TRUE(rendered) << i;
    const ObjectView& view = *rendered;
    ASSERT_EQ(view.mask.size(), view.crop.Size());
    ASSERT_EQ(view.depth_m.size(), view.crop.Size());
    ASSERT_EQ(view.colour.size(), view.crop.Size());
    EXPECT_GE(std::count(view.mask.begin(), view.mask.end(), 255), 250);
    for (size_t k = 0; k < view.mask.size(); ++k) {
      ASSERT_TRUE(view.mask[k] == 0 || view.depth_m[k] > 0.3f);
    }
    without_up += !view.up_C;
    if (view.up_C) {
      EXPECT_NEAR(view.up_C->norm(), 1, 1e-9);
    }
    EXPECT_GE(view.visible_share, 0.4);
    hidden += view.visible_share < 0.97;
  }
  EXPECT_GT(without_up, 0);
  EXPECT_LT(without_up, kViews / 4);
  EXPECT_GT(hidden, kViews / 10);
  EXPECT_LT(hidden, kViews / 2);
}

}  // namespace
}  // namespace beckon::capture
