// Grasps hold, fit the gripper, and stay clear of table, neighbours and each other.
#include "services/pose/grasps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "services/pose/estimate.h"
#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

const Plane kTable;  // z = 0 of W
const GripperConfig kGripper;

FitResult Known(const Superquadric& shape, double sigma_m = 0.001, double sigma_rad = 0.005) {
  FitResult fit;
  fit.shape = shape;
  fit.converged = true;
  fit.covariance.diagonal().head<3>().setConstant(sigma_m * sigma_m);
  fit.covariance.diagonal().tail<3>().setConstant(sigma_rad * sigma_rad);
  return fit;
}

std::vector<GraspCandidate> Propose(const Superquadric& shape,
                                    std::span<const Obstacle> others = {}) {
  return ProposeGrasps(Known(shape), kTable, {others}, kGripper);
}

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

// Whether a point in G is in the steel of the gripper, somewhere on its way.
bool InGripper(const GraspCandidate& g, const Eigen::Vector3d& p) {
  const double back = kGripper.finger_depth_m + kGripper.approach_m;
  const double outside = std::abs(p.x()) - g.opening_m / 2;
  const bool in_finger = outside > 0 && outside < kGripper.finger_thickness_m &&
                         std::abs(p.y()) < kGripper.finger_half_width_m && p.z() < 0 &&
                         p.z() > -back;
  const bool in_palm = std::abs(p.x()) < kGripper.palm_width_m / 2 &&
                       std::abs(p.y()) < kGripper.palm_thickness_m / 2 &&
                       p.z() < -kGripper.finger_depth_m && p.z() > -back - kGripper.palm_depth_m;
  return in_finger || in_palm;
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

// A shape of any kind and size that stands, lies or leans on the table.
Superquadric RandomShape(std::mt19937& engine) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  Eigen::Vector3d semi_axes;
  for (const int i : {0, 1, 2}) semi_axes[i] = uniform(0.01, i == 2 ? 0.12 : 0.06);
  const double e1 = uniform(0.1, 1.5), e2 = uniform(0.1, 1.5), turn = uniform(-3, 3);
  Superquadric shape = MakeShape(semi_axes, e1, e2, {0, 0, 0}, {0, 0, turn});
  const double lean = std::array{0.0, M_PI / 2, uniform(-0.4, 0.4)}[engine() % 3];
  shape.X_FO.linear() =
      shape.X_FO.linear() * Eigen::AngleAxisd(lean, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const double x = uniform(-1, 1), y = uniform(-1, 1);
  shape.X_FO.translation() = Eigen::Vector3d(x, y, HalfWidth(shape, Eigen::Vector3d::UnitZ()));
  return shape;
}

Obstacle ObstacleOf(const Superquadric& shape, int points = 1000) {
  return MakeObstacle(WholeSurface(shape, points), Known(shape), kGripper.clearance_m);
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
  EXPECT_TRUE(ProposeGrasps(fit, kTable, {}, kGripper).empty());
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
  const auto in_C = ProposeGrasps(Known(view.shape_C), view.table_C, {}, kGripper);
  ASSERT_EQ(in_W.size(), in_C.size());
  for (size_t i = 0; i < in_W.size(); ++i) EXPECT_NEAR(in_W[i].score, in_C[i].score, 1e-6);
}

TEST(Grasps, OfARoundCanDoNotDependOnItsFittedTurn) {
  const auto straight = Propose(MakeShape({0.033, 0.033, 0.06}, 0.2, 1, {0.1, 0.5, 0.06}));
  const auto turned =
      Propose(MakeShape({0.033, 0.033, 0.06}, 0.2, 1, {0.1, 0.5, 0.06}, {0, 0, 0.7}));
  ASSERT_EQ(straight.size(), turned.size());
  for (size_t i = 0; i < straight.size(); ++i) {
    EXPECT_TRUE(straight[i].X_FG.isApprox(turned[i].X_FG, 1e-6));
    EXPECT_NEAR(straight[i].score, turned[i].score, 1e-6);
  }
}

TEST(Grasps, OfACanWhoseTurnNobodyKnowsAreAsSure) {
  FitResult can = Known(MakeShape({0.033, 0.033, 0.06}, 0.2, 1, {0, 0, 0.06}));
  const auto known = ProposeGrasps(can, kTable, {}, kGripper);
  can.covariance(5, 5) = 3.3;  // about z
  const auto unknown = ProposeGrasps(can, kTable, {}, kGripper);
  ASSERT_FALSE(known.empty());
  ASSERT_EQ(known.size(), unknown.size());
  EXPECT_NEAR(known[0].score, unknown[0].score, 1e-3);

  FitResult box = Known(MakeShape({0.02, 0.04, 0.06}, 0.1, 0.1, {0, 0, 0.06}));
  const double sure = ProposeGrasps(box, kTable, {}, kGripper).at(0).score;
  box.covariance(5, 5) = 3.3;
  EXPECT_LT(ProposeGrasps(box, kTable, {}, kGripper).at(0).score, 0.8 * sure);
}

TEST(Grasps, AreTheSameEveryTime) {
  std::mt19937 engine(9);
  for (int i = 0; i < 10; ++i) {
    const Superquadric shape = RandomShape(engine);
    const std::vector<Obstacle> others = {ObstacleOf(RandomShape(engine))};
    const auto a = Propose(shape, others), b = Propose(shape, others);
    ASSERT_EQ(a.size(), b.size());
    for (size_t k = 0; k < a.size(); ++k) {
      EXPECT_EQ(a[k].X_FG.matrix(), b[k].X_FG.matrix());
      EXPECT_EQ(a[k].score, b[k].score);
    }
  }
}

TEST(Grasps, DifferFromEachOther) {
  const auto grasps = Propose(MakeShape({0.03, 0.03, 0.09}, 0.1, 1, {0, 0, 0.09}));
  ASSERT_GT(grasps.size(), 4u);
  for (size_t i = 0; i < grasps.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      const Pose between = grasps[i].X_FG.inverse() * grasps[k].X_FG;
      const double turn = std::acos(std::clamp(between.linear()(2, 2), -1.0, 1.0));
      const double roll = std::acos(std::min(std::abs(between.linear()(0, 0)), 1.0));
      EXPECT_TRUE(between.translation().norm() > 0.005 || turn > 0.2 || roll > 0.2) << i << k;
    }
  }
}

TEST(Grasps, OfABoxBetweenTwoNeighboursCloseAcrossTheFreeDirection) {
  const auto box_at = [](double x) {
    return MakeShape({0.03, 0.03, 0.05}, 0.1, 0.1, {x, 0.5, 0.05});
  };
  const std::vector<Obstacle> others = {ObstacleOf(box_at(-0.065)), ObstacleOf(box_at(0.065))};
  const auto grasps = Propose(box_at(0), others);
  ASSERT_FALSE(grasps.empty());
  for (const auto& g : grasps) EXPECT_GT(std::abs(g.X_FG.linear()(1, 0)), 0.9);
}

TEST(Grasps, KnowNeighboursByPointsOrByShapeAlone) {
  const Superquadric box = MakeShape({0.03, 0.03, 0.05}, 0.1, 0.1, {0, 0.5, 0.05});
  const Superquadric wall = MakeShape({0.02, 0.2, 0.2}, 0.1, 0.1, {0.055, 0.5, 0.2});
  const auto towards = [](const std::vector<GraspCandidate>& grasps) {
    return std::count_if(grasps.begin(), grasps.end(), [](const GraspCandidate& g) {
      return std::abs(g.X_FG.linear()(0, 0)) > 0.9;
    });
  };
  EXPECT_GT(towards(Propose(box)), 0);
  const std::vector<Obstacle> points = {
      MakeObstacle(WholeSurface(wall, 4000), FitResult{}, kGripper.clearance_m)};
  const std::vector<Obstacle> shape = {MakeObstacle({}, Known(wall), kGripper.clearance_m)};
  for (const auto& others : {points, shape}) {
    EXPECT_EQ(towards(Propose(box, others)), 0);
    EXPECT_FALSE(Propose(box, others).empty());
    EXPECT_GT(towards(ProposeGrasps(Known(box), kTable, {others, 0}, kGripper)), 0) << "itself";
  }
}

TEST(Grasps, OfAnUncertainPoseScoreLower) {
  const Superquadric box = MakeShape({0.03, 0.04, 0.05}, 0.1, 0.1, {0, 0.5, 0.05});
  double last = 1;
  for (const double sigma_m : {0.001, 0.01, 0.02, 0.04}) {
    const auto grasps = ProposeGrasps(Known(box, sigma_m), kTable, {}, kGripper);
    ASSERT_FALSE(grasps.empty());
    EXPECT_LT(grasps[0].score, last);
    last = grasps[0].score;
  }
  // Unknown along x alone: closing along y is better, although the box is narrower along x.
  FitResult fit = Known(MakeShape({0.025, 0.03, 0.05}, 0.1, 0.1, {0, 0.5, 0.05}));
  fit.covariance(0, 0) = 0.02 * 0.02;
  const auto grasps = ProposeGrasps(fit, kTable, {}, kGripper);
  ASSERT_FALSE(grasps.empty());
  EXPECT_GT(std::abs(grasps[0].X_FG.linear()(1, 0)), 0.9);
}

TEST(Grasps, OfAnAmbiguousObjectPreferWhatWorksForAllItsShapes) {
  FitResult fit = Known(MakeShape({0.03, 0.03, 0.05}, 0.1, 0.1, {0, 0.5, 0.05}));
  const double sure = ProposeGrasps(fit, kTable, {}, kGripper).at(0).score;
  fit.ambiguous = true;
  fit.alternatives = {MakeShape({0.07, 0.03, 0.05}, 0.1, 0.1, {0, 0.5, 0.05})};
  const auto grasps = ProposeGrasps(fit, kTable, {}, kGripper);
  ASSERT_FALSE(grasps.empty());
  EXPECT_GT(std::abs(grasps[0].X_FG.linear()(1, 0)), 0.9);
  for (const auto& g : grasps) {
    if (std::abs(g.X_FG.linear()(0, 0)) > 0.9) {
      EXPECT_LE(g.score, 0.5 * sure + 1e-6);
    }
  }
}

TEST(Obstacles, LeaveOutWhatIsNotFinite) {
  const float nan = std::nanf("");
  const std::vector<Eigen::Vector3f> points = {{nan, 0, 0}, {0, INFINITY, 0}, {0, 0, 1e30f}};
  const Obstacle none = MakeObstacle(points, FitResult{}, 0.01);
  EXPECT_EQ(none.points_F.rows(), 0);
  EXPECT_FALSE(Propose(MakeShape({0.03, 0.03, 0.05}, 0.1, 1, {0, 0, 0.05}), {{none}}).empty());
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

TEST(Estimate, OfASceneKeepsGraspsOffTheNeighbours) {
  TableView near = ViewOnTable(MakeShape({0.02, 0.03, 0.05}, 0.1, 0.1, {0, 0, 0.05}), 1500);
  TableView beside = ViewOnTable(MakeShape({0.02, 0.03, 0.05}, 0.1, 0.1, {0.05, 0, 0.05}), 1500);
  const FitInput inputs[] = {{near.points_C, near.table_C}, {beside.points_C, beside.table_C}};
  const auto scene = EstimateScene(inputs, {});
  const auto alone = EstimateObject(inputs[0], {});
  ASSERT_EQ(scene.size(), 2u);
  ASSERT_TRUE(scene[0].fit.converged && scene[1].fit.converged);
  EXPECT_EQ(scene[0].fit.shape.semi_axes, alone.fit.shape.semi_axes);
  const auto across = [&](const std::vector<GraspCandidate>& grasps) {  // towards the other
    return std::count_if(grasps.begin(), grasps.end(), [](const GraspCandidate& g) {
      return std::abs(g.X_FG.linear()(0, 0)) > 0.9;
    });
  };
  EXPECT_GT(across(alone.grasps), 0);
  EXPECT_EQ(across(scene[0].grasps), 0);
  EXPECT_FALSE(scene[0].grasps.empty());
}

}  // namespace
}  // namespace beckon::pose
