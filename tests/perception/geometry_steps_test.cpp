// The parts of segmentation that are ours: voxels, hull, pieces.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "services/perception/table_outline.h"
#include "services/perception/voxel_grid.h"
#include "tests/perception/box_world.h"

namespace beckon::perception {
namespace {

TEST(VoxelGrid, GivesTheMeanOfEachVoxelsPoints) {
  const RgbdImage image = ThreeBoxes().Render();
  const VoxelGrid grid = MakeVoxelGrid(image, 0.01, 0.5, 3);
  std::vector<Eigen::Vector3d> sums(grid.points_C.size(), Eigen::Vector3d::Zero());
  std::vector<int> counts(grid.points_C.size(), 0);
  int n_pixels = 0;
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const uint32_t voxel = grid.voxel_of_pixel[image.Index(u, v)];
      const float depth_m = image.depth_m[image.Index(u, v)];
      EXPECT_EQ(voxel == VoxelGrid::kNone, !(depth_m >= 0.5 && depth_m <= 3));
      if (voxel == VoxelGrid::kNone) continue;
      sums.at(voxel) += image.Point(u, v);
      ++counts[voxel];
      ++n_pixels;
    }
  }
  EXPECT_EQ(n_pixels, grid.n_pixels);
  std::set<std::array<int, 3>> cells;
  for (size_t i = 0; i < sums.size(); ++i) {
    const Eigen::Vector3d mean = sums[i] / counts[i];
    EXPECT_LT((mean - grid.points_C[i].cast<double>()).norm(), 1e-6);
    const Eigen::Vector3i cell = (mean / 0.01).array().floor().cast<int>();
    EXPECT_TRUE(cells.insert({cell.x(), cell.y(), cell.z()}).second) << "two points in one voxel";
  }
}

TEST(ConvexHull, OfASquareWithPointsInsideAndOnItsEdgesIsItsCorners) {
  const auto hull =
      ConvexHull({{0, 0}, {1, 1}, {0.5, 0.5}, {1, 0}, {0.5, 0}, {0, 1}, {0, 0}, {0.2, 0.7}});
  EXPECT_EQ(hull, (std::vector<Eigen::Vector2d>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
}

TEST(ConvexHull, OfALineOrLessHasFewerThanThreeVertices) {
  EXPECT_LT(ConvexHull({}).size(), 3u);
  EXPECT_LT(ConvexHull({{1, 2}}).size(), 3u);
  EXPECT_LT(ConvexHull({{1, 2}, {1, 2}, {1, 2}}).size(), 3u);
  EXPECT_LT(ConvexHull({{0, 0}, {1, 1}, {2, 2}, {3, 3}}).size(), 3u);
}

TEST(Contains, TellsInsideFromOutside) {
  const std::vector<Eigen::Vector2d> square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  EXPECT_TRUE(Contains(square, {0.5, 0.5}));
  EXPECT_TRUE(Contains(square, {1, 0.5}));
  EXPECT_FALSE(Contains(square, {1.001, 0.5}));
  EXPECT_FALSE(Contains(square, {0.5, -0.001}));
  EXPECT_FALSE(Contains({}, {0, 0}));
}

TEST(DepthInside, IsTheDistanceToTheNearestEdge) {
  const std::vector<Eigen::Vector2d> rectangle{{0, 0}, {4, 0}, {4, 2}, {0, 2}};
  EXPECT_DOUBLE_EQ(DepthInside(rectangle, {2, 1}), 1);
  EXPECT_DOUBLE_EQ(DepthInside(rectangle, {0.25, 1}), 0.25);
  EXPECT_DOUBLE_EQ(DepthInside(rectangle, {5, 1}), -1);
}

TEST(LargestPiece, LeavesOutWhatIsFarAway) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 100; ++i) points.emplace_back(0.01 * (i % 10), 0.01 * (i / 10));
  for (int i = 0; i < 50; ++i) points.emplace_back(0.5 + 0.01 * i, 0.3);
  EXPECT_EQ(LargestPiece(points, 0.1).size(), 100u);
  EXPECT_EQ(LargestPiece(points, 1.0).size(), 150u);
  EXPECT_TRUE(LargestPiece({}, 0.1).empty());
}

TEST(PlaneAxes, AreRightHandedWithTheNormal) {
  for (const Eigen::Vector3d& n : {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 0, 0),
                                   Eigen::Vector3d(0.1, -0.7, -0.7).normalized()}) {
    const PlaneAxes axes(Plane{n, 0.5});
    EXPECT_LT((axes.x.cross(axes.y) - n).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace beckon::perception
