// The parts of fast segmentation on their own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "services/perception/depth_smoothing.h"
#include "services/perception/flat_blocks.h"
#include "services/perception/fragment_rule.h"
#include "services/perception/grouping_rules.h"
#include "services/perception/neck_rule.h"
#include "services/perception/region_clustering.h"
#include "services/perception/table_planes.h"
#include "services/perception/vessel_rule.h"
#include "tests/perception/box_world.h"

namespace beckon::perception {
namespace {

using testing::ElementsAre;

RgbdImage Camera(int width, int height, double focal_px) {
  RgbdImage image;
  image.width = width;
  image.height = height;
  image.intrinsics = {focal_px, focal_px, (width - 1) / 2.0, (height - 1) / 2.0};
  image.depth_m.assign(static_cast<size_t>(width) * height, 0);
  return image;
}

TEST(SensorNoise, IsTheKinectsOfNguyenAndOthers) {
  const SensorNoise sensor;
  EXPECT_NEAR(sensor.Sigma(1), 0.0012 + 0.0019 * 0.36, 1e-12);
  const InverseDepthNoise inverse(sensor);
  for (double z : {0.5, 1.0, 3.0}) {
    EXPECT_NEAR(inverse(static_cast<float>(1 / z)), sensor.Sigma(z) / (z * z), 1e-7) << z;
  }
}

TEST(DepthGrid, CellsSeeTheSameAngleAtAnyResolution) {
  EXPECT_EQ(PixelsPerCell({262.5, 262.5, 0, 0}), 1);
  EXPECT_EQ(PixelsPerCell({525, 525, 0, 0}), 2);
  EXPECT_EQ(PixelsPerCell({1050, 1050, 0, 0}), 4);
  EXPECT_EQ(PixelsPerCell({100000, 100000, 0, 0}), 8);
}

TEST(DepthGrid, ACellHoldsTheMeanOfTheNearestSurfaceInIt) {
  RgbdImage image = Camera(4, 2, 525);
  image.depth_m = {1.000f, 1.002f, 1.000f, 0.0f, 1.002f, 1.000f, 2.0f, NAN};
  const DepthGrid grid = MakeDepthGrid(image, 0.3, 3, {});
  ASSERT_EQ(grid.Size(), 2u);
  EXPECT_NEAR(grid.inverse_depth[0], 1 / 1.001, 1e-5);
  EXPECT_NEAR(grid.inverse_depth[1], 1, 1e-5);
  EXPECT_EQ(grid.n_pixels, 6);
}

TEST(SmoothInverseDepth, LeavesTiltedPlanesAndStepsAsTheyAre) {
  RgbdImage image = Camera(64, 48, 262.5);
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const float w = u < 32 ? 1.0f + 0.004f * static_cast<float>(u) : 0.8f;
      image.depth_m[image.Index(u, v)] = 1 / w;
    }
  }
  const DepthGrid grid = MakeDepthGrid(image, 0.3, 3, {});
  const auto smooth = SmoothInverseDepth(grid, {0, 0, grid.width, grid.height}, {});
  for (size_t i = 0; i < grid.Size(); ++i) EXPECT_NEAR(smooth[i], grid.inverse_depth[i], 1e-5) << i;
}

TEST(FlatBlocks, BearHolesAndKnowTheirNormals) {
  const BoxWorld world{.boxes = {Table()}};
  RgbdImage image = world.Render();
  for (size_t i = 0; i < image.depth_m.size(); i += 5) image.depth_m[i] = 0;
  const auto blocks = FlatBlocks(MakeDepthGrid(image, 0.3, 3, {}), InverseDepthNoise({}));
  const Eigen::Vector3d up_C = world.X_WC().linear().transpose() * Eigen::Vector3d::UnitZ();
  ASSERT_GT(blocks.size(), 500u);
  int n_level = 0;
  for (const Block& b : blocks) n_level += b.normal.cast<double>().dot(up_C) > 0.999;
  EXPECT_GT(n_level, 0.95 * static_cast<double>(blocks.size()));
}

TEST(ClusterSignedGraph, AWrongEdgeIsOutvotedByTheRestOfTheBorder) {
  // Two squares of four patches; three of the four edges between them speak against.
  std::vector<SignedEdge> edges;
  for (int base : {0, 4}) {
    edges.push_back({base, base + 1, 1, 6});
    edges.push_back({base + 1, base + 2, 1, 6});
    edges.push_back({base + 2, base + 3, 1, 6});
    edges.push_back({base, base + 3, 1, 6});
  }
  edges.push_back({0, 4, 1, 6});
  for (int i : {1, 2, 3}) edges.push_back({i, i + 4, -1, 6});
  const std::vector<float> sizes(8, 36);
  EXPECT_THAT(ClusterSignedGraph(sizes, edges), ElementsAre(0, 0, 0, 0, 1, 1, 1, 1));
  edges.resize(9);
  EXPECT_THAT(ClusterSignedGraph(sizes, edges), ElementsAre(0, 0, 0, 0, 0, 0, 0, 0));
}

TEST(ClusterSignedGraph, ASingleCellDoesNotBridgeTwoObjectsBeforeTheyHaveGrown) {
  // Patch 4 is of the second object, whose noise speaks little for it; one cell of the first
  // touches it, too.
  std::vector<SignedEdge> edges;
  for (int i : {0, 1, 2}) edges.push_back({i, i + 1, 1, 6});
  for (int i : {5, 6, 7}) edges.push_back({i, i + 1, 1, 6});
  edges.push_back({3, 4, 1, 1});
  for (int i : {5, 6, 7}) edges.push_back({4, i, 0.3f, 6});
  const std::vector<float> sizes(9, 64);
  EXPECT_THAT(ClusterSignedGraph(sizes, edges), ElementsAre(0, 0, 0, 0, 1, 1, 1, 1, 1));
}

TEST(ClusterSignedGraph, OfNothingIsNothing) {
  EXPECT_TRUE(ClusterSignedGraph({}, {}).empty());
  const std::vector<float> sizes(2, 36);
  EXPECT_THAT(ClusterSignedGraph(sizes, {}), ElementsAre(0, 1));
}

Patch PatchAt(const Eigen::Vector3f& centre, const Eigen::Vector3f& normal) {
  Patch patch;
  patch.n_cells = 36;
  patch.centre_C = centre;
  patch.normal_C = patch.steady_normal_C = normal.normalized();
  return patch;
}

TEST(CreaseAngle, IsPositiveWhereConvexAndNegativeWhereConcave) {
  const Patch left = PatchAt({-0.01f, 0, 1}, {-1, 0, -1}),
              right = PatchAt({0.01f, 0, 1}, {1, 0, -1});
  EXPECT_NEAR(CreaseAngle(left, right), 1.5708, 1e-3);
  const Patch inner_left = PatchAt({-0.01f, 0, 1}, {1, 0, -1});
  const Patch inner_right = PatchAt({0.01f, 0, 1}, {-1, 0, -1});
  EXPECT_NEAR(CreaseAngle(inner_left, inner_right), -1.5708, 1e-3);
  EXPECT_EQ(ConvexityEvidence(left, right), 1);
  EXPECT_EQ(ConvexityEvidence(inner_left, inner_right), -1);
}

TEST(LocalEvidence, StepsAlongABorderSpeakAgainstIt) {
  SurfacePatches patches;
  patches.patches = {PatchAt({-0.01f, 0, 1}, {0, 0, -1}), PatchAt({0.01f, 0, 1}, {0, 0, -1})};
  PatchEdge edge{0, 1, 6};
  const Neighbours neighbours = FindNeighbours(patches, {edge});
  const SignedEdge touching = LocalEvidence(patches, neighbours, edge);
  EXPECT_EQ(touching.evidence, 1);
  EXPECT_EQ(touching.length, 6);
  edge.n_a_before = 3;
  edge.n_b_before = 1;
  const SignedEdge stepped = LocalEvidence(patches, neighbours, edge);
  EXPECT_LT(stepped.evidence, 1);
  EXPECT_GT(stepped.evidence, 0);
  EXPECT_GT(stepped.length, 6);
  edge.n_touching = 0;
  EXPECT_EQ(LocalEvidence(patches, neighbours, edge).evidence, -1);
}

/// A scene of patches alone: seen from the side, the table below.
struct PatchesOnly {
  DepthGrid grid;
  SurfaceCells cells;
  SurfacePatches patches;
  std::vector<PatchEdge> edges;
  Plane table_C{{0, -1, 0}, 0.3};
  SensorNoise sensor;
  PatchScene scene{grid, cells, patches, edges, table_C, sensor};
  std::vector<int> all;

  /// Gives each patch its cells, 10 x 10 of them.
  void Draw() {
    grid.width = grid.height = 160;
    grid.fx = grid.fy = 262;
    grid.cx = 60;
    patches.patch_of_cell.assign(grid.width * grid.height, SurfacePatches::kNone);
    for (int i : all) {
      Patch& patch = patches.patches[i];
      patch.u = grid.cx + grid.fx * patch.centre_C.x() / patch.centre_C.z();
      patch.v = grid.cy + grid.fy * patch.centre_C.y() / patch.centre_C.z();
      for (int cell = 0; cell < 100; ++cell) {
        patches.patch_of_cell[grid.Index(static_cast<int>(patch.u) + cell % 10 - 5,
                                         static_cast<int>(patch.v) + cell / 10 - 5)] = i;
      }
    }
  }

  void Add(const Eigen::Vector3f& centre, const Eigen::Vector3f& normal) {
    all.push_back(static_cast<int>(patches.patches.size()));
    patches.patches.push_back(PatchAt(centre, normal));
  }
};

TEST(FitWall, FindsTheAxisAndTheProfileOfABowl) {
  PatchesOnly bowl;  // radius 4 cm at the table, 2 cm more for each 10 cm of height
  for (float h : {0.02f, 0.05f, 0.08f}) {
    for (float angle = -1.2f; angle <= 1.2f; angle += 0.3f) {
      const float r = 0.04f + 0.2f * h;
      bowl.Add({0.1f + r * std::sin(angle), 0.3f - h, 0.9f - r * std::cos(angle)},
               {std::sin(angle), 0.2f, -std::cos(angle)});
    }
  }
  const PlaneAxes axes(bowl.table_C);
  const auto wall = FitWall(bowl.scene, axes, bowl.all);
  ASSERT_TRUE(wall);
  EXPECT_LT((wall->centre - axes(Eigen::Vector3d(0.1, 0.3, 0.9))).norm(), 0.002);
  EXPECT_NEAR(wall->Radius(0.05), 0.05, 0.002);
  EXPECT_NEAR(wall->rim_height_m, 0.08, 1e-6);
}

TEST(FitWall, RefusesTheTwoSidesOfABox) {
  PatchesOnly box;
  for (float h : {0.02f, 0.05f, 0.08f}) {
    for (float t : {0.01f, 0.03f, 0.05f, 0.07f}) {
      box.Add({t, 0.3f - h, 0.9f + t}, {1, 0, -1});
      box.Add({-t, 0.3f - h, 0.9f + t}, {-1, 0, -1});
    }
  }
  EXPECT_FALSE(FitWall(box.scene, PlaneAxes(box.table_C), box.all));
}

/// The patches of an upright cylinder around (x, 0.9) seen from the origin.
void AddCylinder(PatchesOnly& scene, float x, float radius, std::initializer_list<float> heights) {
  for (float h : heights) {
    for (float angle = -1.2f; angle <= 1.2f; angle += 0.4f) {
      scene.Add({x + radius * std::sin(angle), 0.3f - h, 0.9f - radius * std::cos(angle)},
                {std::sin(angle), 0, -std::cos(angle)});
    }
  }
}

/// The far inside of an upright cylinder around (x, 0.9), between two angles from straight away.
void AddInside(PatchesOnly& scene, float x, float radius, float from, float to,
               std::initializer_list<float> heights) {
  for (float h : heights) {
    for (float angle = from; angle <= to; angle += 0.3f) {
      scene.Add({x + radius * std::sin(angle), 0.3f - h, 0.9f + radius * std::cos(angle)},
                {-std::sin(angle), 0, -std::cos(angle)});
    }
  }
}

/// Patches a and b, and all that lie between them in number, touch in a row.
void TouchInARow(PatchesOnly& scene, int a, int b) {
  for (int i = a; i < b; ++i) scene.edges.push_back({i, i + 1, 6});
}

TEST(JoinInsides, JoinsTheTwoHalvesOfATornBowl) {
  for (const auto& [shift_m, n_groups] : {std::pair(0.0f, 1), std::pair(0.08f, 2)}) {
    PatchesOnly bowl;
    AddInside(bowl, 0, 0.07f, -0.95f, -0.05f, {0.03f, 0.05f});
    const auto n = static_cast<int>(bowl.all.size());
    AddInside(bowl, shift_m, 0.07f, 0.05f, 0.95f, {0.03f, 0.05f});
    std::vector<int> group_of_patch(bowl.all.size(), 1);
    std::fill_n(group_of_patch.begin(), n, 0);
    TouchInARow(bowl, n - 1, n);
    PatchGroups groups(group_of_patch);
    const auto vessels = JoinInsides(bowl.scene, groups);
    EXPECT_EQ(vessels.size(), n_groups == 1 ? 1u : 0u);
    EXPECT_EQ(groups.Of(0) == groups.Of(n), n_groups == 1) << "shifted by " << shift_m << " m";
  }
}

TEST(JoinInsides, TakesWhatTheRimShowsAndNotWhatTheVesselStandsOn) {
  PatchesOnly scene;
  AddCylinder(scene, 0, 0.04f, {0.05f, 0.07f, 0.09f, 0.1f});
  std::vector<int> group_of_patch(scene.all.size(), 0);
  AddInside(scene, 0, 0.038f, -0.6f, 0.6f, {0.085f, 0.09f});
  const int inside = static_cast<int>(group_of_patch.size());
  group_of_patch.resize(scene.all.size(), 1);
  const int below = static_cast<int>(group_of_patch.size());
  for (float x : {-0.02f, 0.0f, 0.02f}) scene.Add({x, 0.29f, 0.87f}, {0, 0, -1});
  group_of_patch.resize(scene.all.size(), 2);
  PatchGroups groups(group_of_patch);
  JoinInsides(scene.scene, groups);
  EXPECT_EQ(groups.Of(inside), groups.Of(0));
  EXPECT_NE(groups.Of(below), groups.Of(0));
}

TEST(JoinFragments, WhatFloatsBelongsToWhatIsNear) {
  // A wall of a mug, and its handle beside it: on the table, in the air, and in the air far away.
  for (const auto& [x, h, joined] :
       {std::tuple(0.045f, 0.01f, false), std::tuple(0.045f, 0.05f, true),
        std::tuple(0.12f, 0.05f, false)}) {
    PatchesOnly scene;
    for (float height : {0.02f, 0.05f, 0.08f}) scene.Add({0, 0.3f - height, 0.9f}, {0, 0, -1});
    scene.Add({x, 0.3f - h, 0.9f}, {0, 0, -1});
    for (Patch& patch : scene.patches.patches) patch.area_m2 = 0.0011f;
    scene.patches.patches.back().area_m2 = 0.0003f;
    scene.Draw();
    PatchGroups groups({0, 0, 0, 1});
    JoinFragments(scene.scene, groups);
    EXPECT_EQ(groups.Of(3) == groups.Of(0), joined) << x << " m beside, " << h << " m high";
  }
}

TEST(IsBottom, IsSeenThroughTheRim) {
  PatchesOnly scene;
  const PlaneAxes axes(scene.table_C);
  Wall wall;
  wall.centre = axes(Eigen::Vector3d(0, 0.3, 0.4));
  wall.profile = {0.05, 0, 0};
  wall.foot_height_m = 0.01;
  wall.rim_height_m = 0.06;
  const Vessel vessel{0, wall};
  EXPECT_TRUE(IsBottom(scene.scene, axes, vessel, {0, 0.3, 0.44}));
  EXPECT_FALSE(IsBottom(scene.scene, axes, vessel, {0, 0.3, 0.36})) << "hidden by the near wall";
  EXPECT_FALSE(IsBottom(scene.scene, axes, vessel, {0, 0.3, 0.5})) << "behind the vessel";
}

TEST(JoinNecks, JoinsWhatIsSlimAndOnTheAxisOnly) {
  for (const auto& [x, n_groups] : {std::pair(0.0f, 1), std::pair(0.015f, 2)}) {
    PatchesOnly bottle;
    AddCylinder(bottle, 0, 0.04f, {0.02f, 0.06f, 0.10f});
    const auto n_body = bottle.all.size();
    AddCylinder(bottle, x, 0.014f, {0.13f, 0.15f});
    std::vector<int> group(bottle.all.size(), 0);
    std::fill(group.begin() + static_cast<std::ptrdiff_t>(n_body), group.end(), 1);
    PatchEdge edge{static_cast<int>(n_body) - 1, static_cast<int>(n_body)};
    edge.n_touching = 5;
    bottle.edges.push_back(edge);
    PatchGroups groups(group);
    JoinNecks(bottle.scene, groups);
    EXPECT_EQ(groups.Members(1).empty(), n_groups == 1) << x;
  }
}

}  // namespace
}  // namespace beckon::perception
