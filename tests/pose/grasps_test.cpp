// Grasps fit the gripper and stay clear of the table.
#include "services/pose/grasps.h"

#include <gtest/gtest.h>

#include "services/pose/estimate.h"
#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

const Plane kTable;  // z = 0 of W
const GripperConfig kGripper;

int FromAbove(const std::vector<GraspCandidate>& grasps) {
  int count = 0;
  for (const auto& g : grasps) count += g.X_FG.linear().col(2).z() < -0.9;
  return count;
}

void ExpectSound(const std::vector<GraspCandidate>& grasps, const Superquadric& shape) {
  double best = 1;
  for (const auto& g : grasps) {
    const Eigen::Matrix3d& R = g.X_FG.linear();
    EXPECT_NEAR(R.determinant(), 1, 1e-9);
    EXPECT_TRUE((R.transpose() * R).isIdentity(1e-9));
    EXPECT_LE(g.opening_m, kGripper.max_opening_m);
    EXPECT_GE(g.opening_m, 2 * HalfWidth(shape, R.col(0)) + 2 * kGripper.clearance_m - 1e-9);
    EXPECT_GE(kTable.Distance(g.X_FG.translation()), kGripper.clearance_m - 1e-12);
    EXPECT_LT(Gauge(shape, shape.X_FO.inverse() * g.X_FG.translation()), 1) << "closes on air";
    EXPECT_GE(g.score, 0);
    EXPECT_LE(g.score, best);
    best = g.score;
  }
}

TEST(Grasps, OfATallCanComeFromAboveAndFromTheSides) {
  const Superquadric can = MakeShape({0.033, 0.033, 0.06}, 0.2, 1, {0.1, 0.5, 0.06});
  const auto grasps = ProposeGrasps(can, kTable, kGripper);
  EXPECT_EQ(grasps.size(), 6u);
  EXPECT_EQ(FromAbove(grasps), 2);
  ExpectSound(grasps, can);
}

TEST(Grasps, CloseAcrossTheNarrowSideOnly) {
  const Superquadric carton = MakeShape({0.03, 0.09, 0.03}, 0.1, 0.1, {0, 0.5, 0.03}, {0, 0, 0.4});
  const auto grasps = ProposeGrasps(carton, kTable, kGripper);
  ASSERT_EQ(grasps.size(), 1u);  // low: from above; 0.18 m: across the other axis only
  EXPECT_GT(std::abs(grasps[0].X_FG.linear().col(0).dot(carton.X_FO.linear().col(0))), 0.999);
  EXPECT_NEAR(grasps[0].opening_m, 0.08, 1e-3);
  ExpectSound(grasps, carton);
}

TEST(Grasps, AreNoneForWhatIsTooWide) {
  EXPECT_TRUE(ProposeGrasps(MakeShape({0.06, 0.06, 0.06}, 0.2, 0.2, {0, 0, 0.06}), kTable, kGripper)
                  .empty());
}

TEST(Grasps, NeverReachIntoTheTable) {
  for (double half_height : {0.004, 0.006, 0.01, 0.02, 0.05, 0.1}) {
    for (double sunk : {0.0, 0.005, 0.02}) {  // a fit may reach below the table
      const Superquadric box =
          MakeShape({0.03, 0.03, half_height}, 0.1, 0.1, {0, 0, half_height - sunk}, {0.05, 0, 0});
      ExpectSound(ProposeGrasps(box, kTable, kGripper), box);
    }
  }
  EXPECT_TRUE(
      ProposeGrasps(MakeShape({0.03, 0.03, 0.004}, 0.1, 0.1, {0, 0, 0.004}), kTable, kGripper)
          .empty());
}

TEST(Grasps, OfALyingCylinderCloseAcrossIt) {
  const Superquadric tube = MakeShape({0.02, 0.02, 0.08}, 0.2, 1, {0, 0.4, 0.02}, {0, M_PI / 2, 0});
  const auto grasps = ProposeGrasps(tube, kTable, kGripper);
  ASSERT_FALSE(grasps.empty());
  EXPECT_LT(std::abs(grasps[0].X_FG.linear().col(0).dot(tube.X_FO.linear().col(2))), 1e-6);
  ExpectSound(grasps, tube);
}

TEST(Grasps, TurnWithTheFrame) {
  const Superquadric shape_W = MakeShape({0.033, 0.033, 0.06}, 0.2, 1, {0, 0, 0.06});
  const TableView view = ViewOnTable(shape_W, 100);
  const auto in_W = ProposeGrasps(shape_W, kTable, kGripper);
  const auto in_C = ProposeGrasps(view.shape_C, view.table_C, kGripper);
  ASSERT_EQ(in_W.size(), in_C.size());
  for (size_t i = 0; i < in_W.size(); ++i) EXPECT_NEAR(in_W[i].score, in_C[i].score, 1e-6);
}

TEST(Estimate, TurnsThePlaneToTheCamera) {
  const TableView view = ViewOnTable(MakeShape({0.033, 0.033, 0.06}, 0.2, 1, {0, 0, 0.06}), 2000);
  const Plane flipped{-view.table_C.normal, -view.table_C.offset_m};
  const Estimate a = EstimateObject({view.points_C, view.table_C}, {});
  const Estimate b = EstimateObject({view.points_C, flipped}, {});
  EXPECT_EQ(a.fit.shape.semi_axes, b.fit.shape.semi_axes);
  EXPECT_FALSE(a.grasps.empty());
  EXPECT_EQ(a.grasps.size(), b.grasps.size());
  EXPECT_TRUE(EstimateObject({view.points_C, {}}, {}).grasps.empty());
}

}  // namespace
}  // namespace beckon::pose
