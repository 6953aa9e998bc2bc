// Grasps hold, fit the gripper, and stay clear of table, neighbours and the object itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/pose/grasp_scenes.h"

namespace beckon::pose {
namespace {

int FromAbove(const std::vector<GraspCandidate>& grasps) {
  int count = 0;
  for (const auto& g : grasps) count += g.X_FG.linear().col(2).z() < -0.999;
  return count;
}

int FromTheSide(const std::vector<GraspCandidate>& grasps) {
  int count = 0;
  for (const auto& g : grasps) count += std::abs(g.X_FG.linear().col(2).z()) < 1e-3;
  return count;
}

// Points all through the gripper on its way, in F.
std::vector<Eigen::Vector3d> PointsOfGripper(const GraspCandidate& g) {
  std::vector<Eigen::Vector3d> points;
  const double length = kGripper.finger_depth_m + kGripper.approach_m + kGripper.palm_depth_m;
  for (double z = -length; z <= 0; z += 0.005) {
    for (double y = -0.03; y <= 0.03; y += 0.005) {
      for (double x = -0.065; x <= 0.065; x += 0.0025) {
        if (InGripper(g, {x, y, z})) points.push_back(g.X_FG * Eigen::Vector3d(x, y, z));
      }
    }
  }
  return points;
}

void ExpectContactsHold(const GraspCandidate& g, const Superquadric& shape) {
  for (const int side : {0, 1}) {
    const Eigen::Vector3d p_O = shape.X_FO.inverse() * g.contacts_F[static_cast<size_t>(side)];
    EXPECT_NEAR(Gauge(shape, p_O), 1, 1e-5);
    const Eigen::Vector3d normal = shape.X_FO.linear() * NormalAt(shape, p_O);
    const double slip =
        std::acos(std::clamp((side == 0 ? 1 : -1) * normal.dot(g.X_FG.linear().col(0)), -1.0, 1.0));
    EXPECT_LE(slip, kGripper.max_slip_rad + 1e-6);
    const Eigen::Vector3d p_G = g.X_FG.inverse() * g.contacts_F[static_cast<size_t>(side)];
    EXPECT_LT(std::abs(p_G.x()), g.opening_m / 2 - kGripper.clearance_m + 1e-4);
    EXPECT_LT(std::abs(p_G.y()), kGripper.finger_half_width_m);
    EXPECT_TRUE(p_G.z() <= 0 && p_G.z() > -kGripper.finger_depth_m);
  }
}

void ExpectSound(const std::vector<GraspCandidate>& grasps, const Superquadric& shape) {
  EXPECT_LE(grasps.size(), static_cast<size_t>(kMostGrasps));
  const auto surface = SampleSurface(shape, 3000);
  double best = 1;
  for (const auto& g : grasps) {
    const Eigen::Matrix3d& R = g.X_FG.linear();
    EXPECT_TRUE(g.X_FG.matrix().allFinite());
    EXPECT_NEAR(R.determinant(), 1, 1e-9);
    EXPECT_TRUE((R.transpose() * R).isIdentity(1e-9));
    EXPECT_LE(g.opening_m, kGripper.max_opening_m);
    EXPECT_GE(kTable.Distance(g.X_FG.translation()), kGripper.clearance_m - 1e-12);
    EXPECT_LT(Gauge(shape, shape.X_FO.inverse() * g.X_FG.translation()), 1) << "closes on air";
    EXPECT_GE(g.score, 0);
    EXPECT_LE(g.score, best);
    best = g.score;
    ExpectContactsHold(g, shape);
    for (const auto& p : PointsOfGripper(g)) {
      ASSERT_GT(kTable.Distance(p), 0.9 * kGripper.clearance_m);
    }
    for (const auto& p : surface) {
      const Eigen::Vector3d p_G = g.X_FG.inverse() * p;
      ASSERT_FALSE(InGripper(g, p_G)) << p_G.transpose();
      if (std::abs(p_G.y()) < kGripper.finger_half_width_m && p_G.z() < 0) {
        ASSERT_LT(std::abs(p_G.x()), g.opening_m / 2 - kGripper.clearance_m + 1e-9);
      }
    }
  }
}

TEST(Grasps, OfAnyShapeAreSound) {
  std::mt19937 engine(7);
  int found = 0;
  for (int i = 0; i < 100; ++i) {
    const Superquadric shape = RandomShape(engine);
    const auto grasps = Propose(shape);
    found += !grasps.empty();
    ExpectSound(grasps, shape);
    if (HasFatalFailure() || HasFailure()) {
      FAIL() << "shape " << i << " " << shape.semi_axes.transpose() << " "
             << shape.epsilon.transpose();
    }
  }
  EXPECT_GT(found, 50);
}

TEST(Grasps, AmongNeighboursTouchNone) {
  std::mt19937 engine(8);
  std::uniform_real_distribution<double> aside(-0.15, 0.15);
  int found = 0, fewer = 0;
  for (int i = 0; i < 40; ++i) {
    const Superquadric shape = RandomShape(engine);
    std::vector<Superquadric> neighbours;
    std::vector<Obstacle> obstacles;
    for (int k = 0; k < 4; ++k) {
      Superquadric neighbour = RandomShape(engine);
      neighbour.X_FO.translation().head<2>() =
          shape.X_FO.translation().head<2>() + Eigen::Vector2d(aside(engine), aside(engine));
      neighbours.push_back(neighbour);
      obstacles.push_back(ObstacleOf(neighbour));
    }
    const auto grasps = Propose(shape, obstacles);
    ExpectSound(grasps, shape);
    found += !grasps.empty();
    fewer += grasps.size() < Propose(shape).size();
    for (const auto& g : grasps) {
      const auto gripper = PointsOfGripper(g);
      for (const auto& neighbour : neighbours) {
        const Pose X_OF = neighbour.X_FO.inverse();
        for (const auto& p : gripper) ASSERT_GT(Gauge(neighbour, X_OF * p), 1) << i;
      }
    }
  }
  EXPECT_GT(found, 5);
  EXPECT_GT(fewer, 10);
}

TEST(Grasps, OfATallCanComeFromAboveAndFromTheSides) {
  const Superquadric can = MakeShape({0.033, 0.033, 0.06}, 0.2, 1, {0.1, 0.5, 0.06});
  const auto grasps = Propose(can);
  EXPECT_GE(FromAbove(grasps), 2);
  EXPECT_GE(FromTheSide(grasps), 4);
  ExpectSound(grasps, can);
}

TEST(Grasps, CloseAcrossTheNarrowSideOnly) {
  const Superquadric carton = MakeShape({0.03, 0.09, 0.03}, 0.1, 0.1, {0, 0.5, 0.03}, {0, 0, 0.4});
  const auto grasps = Propose(carton);
  ASSERT_FALSE(grasps.empty());  // 0.18 m: across the other axis only
  for (const auto& g : grasps) {
    EXPECT_GT(std::abs(g.X_FG.linear().col(0).dot(carton.X_FO.linear().col(0))),
              std::cos(kGripper.max_slip_rad));
  }
  EXPECT_GT(std::abs(grasps[0].X_FG.linear().col(0).dot(carton.X_FO.linear().col(0))), 0.999);
  EXPECT_NEAR(grasps[0].opening_m, 0.08, 5e-3);
  ExpectSound(grasps, carton);
}

TEST(Grasps, OfALongObjectTakeSeveralPlaces) {
  const Superquadric bar = MakeShape({0.015, 0.1, 0.015}, 0.1, 0.1, {0, 0, 0.015}, {0, 0, 0.3});
  double least = 1, most = -1;
  for (const auto& g : Propose(bar)) {
    const double place = (bar.X_FO.inverse() * g.X_FG.translation()).y();
    least = std::min(least, place);
    most = std::max(most, place);
  }
  EXPECT_LT(least, -0.03);
  EXPECT_GT(most, 0.03);
}

TEST(Grasps, AreNoneForWhatIsTooWide) {
  EXPECT_TRUE(Propose(MakeShape({0.06, 0.06, 0.06}, 0.2, 0.2, {0, 0, 0.06})).empty());
}

TEST(Grasps, AreNoneWithoutAFit) {
  FitResult fit = Known(MakeShape({0.03, 0.03, 0.06}, 0.2, 1, {0, 0, 0.06}));
  fit.converged = false;
  EXPECT_TRUE(ProposeGrasps(fit, {}, kTable, {}, kGripper).empty());
}

TEST(Grasps, OfALowFlatBoxComeFromAboveOnly) {
  const Superquadric box = MakeShape({0.03, 0.04, 0.014}, 0.1, 0.1, {0, 0, 0.014});
  const auto grasps = Propose(box);
  ASSERT_FALSE(grasps.empty());
  EXPECT_EQ(FromTheSide(grasps), 0);
  EXPECT_LT(grasps[0].X_FG.linear().col(2).z(), -0.999);
  ExpectSound(grasps, box);
}

TEST(Grasps, NeverReachIntoTheTable) {
  for (double half_height : {0.004, 0.006, 0.01, 0.02, 0.05, 0.1}) {
    for (double sunk : {0.0, 0.005, 0.02}) {  // a fit may reach below the table
      const Superquadric box =
          MakeShape({0.03, 0.03, half_height}, 0.1, 0.1, {0, 0, half_height - sunk}, {0.05, 0, 0});
      ExpectSound(Propose(box), box);
    }
  }
  EXPECT_TRUE(Propose(MakeShape({0.03, 0.03, 0.004}, 0.1, 0.1, {0, 0, 0.004})).empty());
}

TEST(Grasps, OfALyingCylinderCloseAcrossIt) {
  const Superquadric tube = MakeShape({0.02, 0.02, 0.08}, 0.2, 1, {0, 0.4, 0.02}, {0, M_PI / 2, 0});
  const auto grasps = Propose(tube);
  ASSERT_FALSE(grasps.empty());
  EXPECT_LT(std::abs(grasps[0].X_FG.linear().col(0).dot(tube.X_FO.linear().col(2))), 1e-6);
  ExpectSound(grasps, tube);
}

TEST(Grasps, TurnWithTheFrame) {
  const Superquadric shape_W = MakeShape({0.033, 0.033, 0.06}, 0.2, 1, {0, 0, 0.06});
  const TableView view = ViewOnTable(shape_W, 100);
  const auto in_W = Propose(shape_W);
  const auto in_C = ProposeGrasps(Known(view.shape_C), {}, view.table_C, {}, kGripper);
  ASSERT_EQ(in_W.size(), in_C.size());
  for (size_t i = 0; i < in_W.size(); ++i) EXPECT_NEAR(in_W[i].score, in_C[i].score, 1e-6);
}

}  // namespace
}  // namespace beckon::pose
