// Open vessels are pinched by their rim.
#include "services/pose/grasp_rim.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/pose/grasp_scenes.h"

namespace beckon::pose {
namespace {

constexpr double kRadius_m = 0.09, kHeight_m = 0.07;

// The inside of a vessel on the table, at (0.3, 0.2): z / height to the power `flare` of the
// radius; a flare of 0 is a tub. `open`: without a lid.
std::vector<Eigen::Vector3f> Vessel(double flare, bool open) {
  std::vector<Eigen::Vector3f> points;
  const auto add = [&](double radius, double z) {
    for (int i = 0; i < 120; ++i) {
      const double turn = 2 * M_PI * i / 120;
      points.push_back(
          Eigen::Vector3d(0.3 + radius * std::cos(turn), 0.2 + radius * std::sin(turn), z)
              .cast<float>());
    }
  };
  for (double z = 0.004; z <= kHeight_m; z += 0.004) {
    add(kRadius_m * std::pow(z / kHeight_m, flare), z);
  }
  const double foot = kRadius_m * std::pow(0.004 / kHeight_m, flare);
  for (double r = 0.006; r < foot; r += 0.006) add(r, 0.004);
  for (double r = 0.006; !open && r < kRadius_m; r += 0.006) add(r, kHeight_m);
  return points;
}

// What a fit makes of it: too wide for the gripper.
FitResult FitOfVessel() {
  return Known(MakeShape({kRadius_m, kRadius_m, kHeight_m / 2}, 0.3, 1, {0.3, 0.2, kHeight_m / 2}));
}

TEST(RimGrasps, PinchTheWallOfWhatIsOpen) {
  for (const double flare : {0.0, 0.3}) {
    const auto points = Vessel(flare, true);
    const auto grasps = ProposeGrasps(FitOfVessel(), points, kTable, {}, kGripper);
    ASSERT_GE(grasps.size(), 4u) << flare;
    for (const auto& g : grasps) {
      EXPECT_LE(g.opening_m, kGripper.max_opening_m);
      EXPECT_GE(kTable.Distance(g.X_FG.translation()), kGripper.clearance_m - 1e-9);
      EXPECT_LT(g.X_FG.linear().col(2).z(), -0.999);
      const Eigen::Vector3d from_middle = g.X_FG.translation() - Eigen::Vector3d(0.3, 0.2, 0);
      EXPECT_NEAR(from_middle.head<2>().norm(), kRadius_m, 0.015);
      EXPECT_GT(std::abs(from_middle.normalized().dot(g.X_FG.linear().col(0))), 0.7);
      int held = 0;
      for (const auto& p : points) {
        const Eigen::Vector3d p_G = g.X_FG.inverse() * p.cast<double>();
        ASSERT_FALSE(InGripper(g, p_G)) << flare;
        held += std::abs(p_G.x()) < g.opening_m / 2 && p_G.z() < 0 && std::abs(p_G.y()) < 0.01;
      }
      EXPECT_GT(held, 0);
    }
  }
}

TEST(RimGrasps, AreNoneOfWhatIsClosed) {
  EXPECT_TRUE(ProposeGrasps(FitOfVessel(), Vessel(0, false), kTable, {}, kGripper).empty());
  EXPECT_TRUE(
      FindOpenRim(WholeSurface(FitOfVessel().shape, 2000), kTable, kGripper).pinches.empty());
}

TEST(RimGrasps, AreNoneOfAWallThatSlips) {
  EXPECT_TRUE(FindOpenRim(Vessel(0.9, true), kTable, kGripper).pinches.empty());
}

TEST(RimGrasps, AreWhereTheRimWasSeenOnly) {
  auto points = Vessel(0, true);
  std::erase_if(points, [](const auto& p) { return p.y() < 0.15f && p.z() > 0.03f; });
  const OpenRim rim = FindOpenRim(points, kTable, kGripper);
  EXPECT_LT(rim.seen, 1);
  ASSERT_FALSE(rim.pinches.empty());
  for (const auto& pinch : rim.pinches) EXPECT_GT(pinch.X_FG.translation().y(), 0.13);
  std::erase_if(points, [](const auto& p) { return p.y() < 0.24f && p.z() > 0.03f; });
  EXPECT_TRUE(FindOpenRim(points, kTable, kGripper).pinches.empty()) << "too little of it";
}

TEST(RimGrasps, StayOffNeighbours) {
  const auto points = Vessel(0, true);
  const Superquadric wall = MakeShape({0.02, 0.3, 0.2}, 0.1, 0.1, {0.42, 0.2, 0.2});
  const std::vector<Obstacle> others = {ObstacleOf(wall, 4000)};
  const auto grasps = ProposeGrasps(FitOfVessel(), points, kTable, {others}, kGripper);
  ASSERT_FALSE(grasps.empty());
  for (const auto& g : grasps) EXPECT_LT(g.X_FG.translation().x(), 0.36);
}

TEST(RimGrasps, TakeAnyPoints) {
  const float nan = std::nanf("");
  for (const auto& points : std::vector<std::vector<Eigen::Vector3f>>{
           {}, {{nan, nan, nan}}, {{0, 0, 1}}, {{0, 0, 1}, {0, INFINITY, 0}, {1e30f, 0, 0}}}) {
    EXPECT_TRUE(FindOpenRim(points, kTable, kGripper).pinches.empty());
  }
}

}  // namespace
}  // namespace beckon::pose
