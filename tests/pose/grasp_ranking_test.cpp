// Grasps are ranked by what is known of the object and of its neighbours, and differ from each
// other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/pose/grasp_scenes.h"

namespace beckon::pose {
namespace {

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
  const auto known = ProposeGrasps(can, {}, kTable, {}, kGripper);
  can.covariance(5, 5) = 3.3;  // about z
  const auto unknown = ProposeGrasps(can, {}, kTable, {}, kGripper);
  ASSERT_FALSE(known.empty());
  ASSERT_EQ(known.size(), unknown.size());
  EXPECT_NEAR(known[0].score, unknown[0].score, 1e-3);

  FitResult box = Known(MakeShape({0.02, 0.04, 0.06}, 0.1, 0.1, {0, 0, 0.06}));
  const double sure = ProposeGrasps(box, {}, kTable, {}, kGripper).at(0).score;
  box.covariance(5, 5) = 3.3;
  EXPECT_LT(ProposeGrasps(box, {}, kTable, {}, kGripper).at(0).score, 0.8 * sure);
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
    EXPECT_GT(towards(ProposeGrasps(Known(box), {}, kTable, {others, 0}, kGripper)), 0) << "itself";
  }
}

TEST(Grasps, OfAnUncertainPoseScoreLower) {
  const Superquadric box = MakeShape({0.03, 0.04, 0.05}, 0.1, 0.1, {0, 0.5, 0.05});
  double last = 1;
  for (const double sigma_m : {0.001, 0.01, 0.02, 0.04}) {
    const auto grasps = ProposeGrasps(Known(box, sigma_m), {}, kTable, {}, kGripper);
    ASSERT_FALSE(grasps.empty());
    EXPECT_LT(grasps[0].score, last);
    last = grasps[0].score;
  }
  // Unknown along x alone: closing along y is better, although the box is narrower along x.
  FitResult fit = Known(MakeShape({0.025, 0.03, 0.05}, 0.1, 0.1, {0, 0.5, 0.05}));
  fit.covariance(0, 0) = 0.02 * 0.02;
  const auto grasps = ProposeGrasps(fit, {}, kTable, {}, kGripper);
  ASSERT_FALSE(grasps.empty());
  EXPECT_GT(std::abs(grasps[0].X_FG.linear()(1, 0)), 0.9);
}

TEST(Grasps, OfAnAmbiguousObjectPreferWhatWorksForAllItsShapes) {
  FitResult fit = Known(MakeShape({0.03, 0.03, 0.05}, 0.1, 0.1, {0, 0.5, 0.05}));
  const double sure = ProposeGrasps(fit, {}, kTable, {}, kGripper).at(0).score;
  fit.ambiguous = true;
  fit.alternatives = {MakeShape({0.07, 0.03, 0.05}, 0.1, 0.1, {0, 0.5, 0.05})};
  const auto grasps = ProposeGrasps(fit, {}, kTable, {}, kGripper);
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

}  // namespace
}  // namespace beckon::pose
