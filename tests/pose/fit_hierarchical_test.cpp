// The hierarchical search: its seed, its levels, and outliers.
#include "services/pose/fit_hierarchical.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

PointList Doubles(const std::vector<Eigen::Vector3f>& points) {
  PointList doubles;
  for (const auto& p : points) doubles.push_back(p.cast<double>());
  return doubles;
}

Superquadric Can() { return MakeShape({0.04, 0.04, 0.08}, 0.2, 1, {0, 0, 0.8}, {0.5, 0.2, 0.1}); }

TEST(Hierarchical, IsTheSameForTheSameSeedAndFindsTheSameForOthers) {
  const PointList points = Doubles(WholeSurface(Can(), 1500, 0.001));
  HierarchicalConfig config;
  const MethodOutcome a = FitHierarchical(points, config), b = FitHierarchical(points, config);
  EXPECT_EQ(a.shape.X_FO.matrix(), b.shape.X_FO.matrix());
  EXPECT_EQ(a.shape.semi_axes, b.shape.semi_axes);
  for (int seed : {0, 2, 3, 4}) {
    config.seed = seed;
    const MethodOutcome other = FitHierarchical(points, config);
    EXPECT_LT(ShapeDifference(a.shape, other.shape), 0.002) << seed;
  }
}

TEST(Hierarchical, FindsTheAxisOfRoundThings) {
  for (const Eigen::Vector3d& a : {Eigen::Vector3d(0.03, 0.03, 0.09), {0.06, 0.06, 0.02}}) {
    const Superquadric can = MakeShape(a, 0.2, 1, {0, 0, 0.8}, {0.5, 0.2, 0.1});
    const MethodOutcome fit = FitHierarchical(Doubles(WholeSurface(can, 1500)), {});
    EXPECT_GT(std::abs(fit.shape.X_FO.linear().col(2).dot(can.X_FO.linear().col(2))), 0.999);
  }
}

TEST(Hierarchical, LeavesOutLevelsThatAreTooCoarse) {
  const PointList points = Doubles(WholeSurface(Can(), 1500));
  HierarchicalConfig config;
  config.voxels_m = {1.0, 0.015};  // a single voxel holds all
  EXPECT_EQ(FitHierarchical(points, config).iterations.size(), 2u);
  config.voxels_m = {};
  EXPECT_EQ(FitHierarchical(points, config).iterations.size(), 1u);
}

TEST(Hierarchical, EndsWithOneHypothesisAndWithFewPoints) {
  HierarchicalConfig config;
  config.hypotheses = 1;
  config.keep = 0;
  const MethodOutcome fit = FitHierarchical(Doubles(WholeSurface(Can(), 20)), config);
  EXPECT_TRUE(fit.shape.semi_axes.allFinite());
  EXPECT_TRUE(fit.shape.X_FO.matrix().allFinite());
}

}  // namespace
}  // namespace beckon::pose
