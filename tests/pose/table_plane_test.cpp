// The table under labelled objects is found, or said not to be there.
#include "services/pose/table_plane.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

TableScene BoxAndCan(double sigma_m) {
  return SceneOnTable({MakeShape({0.03, 0.04, 0.06}, 0.1, 0.1, {-0.1, 0, 0.06}, {0, 0, 0.5}),
                       MakeShape({0.04, 0.04, 0.05}, 0.1, 1, {0.08, 0.05, 0.05})},
                      sigma_m);
}

void ExpectTable(const TableScene& scene, double angle_rad, double distance_m) {
  const auto plane = FindTablePlane(scene.image, scene.labels);
  ASSERT_TRUE(plane) << plane.error().message;
  EXPECT_GT(plane->normal.dot(scene.table_C.normal), std::cos(angle_rad));
  EXPECT_NEAR(plane->Distance(scene.shapes_C[0].X_FO.translation()), 0.06, distance_m);
}

TEST(TablePlane, IsFoundAroundTheObjects) {
  ExpectTable(BoxAndCan(0), 1e-3, 1e-4);
  ExpectTable(BoxAndCan(0.002), 0.01, 0.001);
}

TEST(TablePlane, IsNotTheWallBehindNorTheTopOfABox) {
  TableScene scene = BoxAndCan(0.001);
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      float& z = scene.image.depth_m[scene.image.Index(u, v)];
      if (scene.labels[scene.image.Index(u, v)] != 0) continue;
      z = std::min(z, 0.93f);  // a wall
      if (u > 230 && v > 60 && v < 140)
        z = 0.75f - 0.002f * (v - 100);  // something nobody labelled
      if (u % 7 == 0) z = 0;
    }
  }
  ExpectTable(scene, 0.02, 0.002);
}

TEST(TablePlane, IsTheSameEachTime) {
  const TableScene scene = BoxAndCan(0.002);
  const auto a = FindTablePlane(scene.image, scene.labels);
  const auto b = FindTablePlane(scene.image, scene.labels);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->normal, b->normal);
  EXPECT_EQ(a->offset_m, b->offset_m);
}

TEST(TablePlane, IsMissedWhereThereIsNone) {
  TableScene scene = BoxAndCan(0);
  for (size_t i = 0; i < scene.labels.size(); ++i) {
    if (scene.labels[i] == 0) scene.image.depth_m[i] = 0;
  }
  const auto nothing = FindTablePlane(scene.image, scene.labels);
  ASSERT_FALSE(nothing);
  EXPECT_THAT(nothing.error().message, testing::HasSubstr("--plane"));

  std::mt19937 engine(2);
  std::uniform_real_distribution<float> depth(0.6f, 1.0f);
  for (size_t i = 0; i < scene.labels.size(); ++i) {
    if (scene.labels[i] == 0) scene.image.depth_m[i] = depth(engine);
  }
  EXPECT_FALSE(FindTablePlane(scene.image, scene.labels)) << "a cloud of dust is no table";
  EXPECT_FALSE(FindTablePlane(scene.image, std::vector<uint16_t>(scene.labels.size(), 0)));
}

}  // namespace
}  // namespace beckon::pose
