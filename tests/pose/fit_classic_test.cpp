// The classic fit: the axis it takes for z, its taper, and the limits of what it fits.
#include "services/pose/fit_classic.h"

#include <gtest/gtest.h>

#include "services/pose/principal_start.h"
#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

PointList Doubles(const std::vector<Eigen::Vector3f>& points) {
  PointList doubles;
  for (const auto& p : points) doubles.push_back(p.cast<double>());
  return doubles;
}

TEST(Classic, TakesTheAxisThatStandsApartForZ) {
  for (const Eigen::Vector3d& a : {Eigen::Vector3d(0.03, 0.03, 0.09), {0.06, 0.06, 0.02}}) {
    const Superquadric can = MakeShape(a, 0.2, 1, {0, 0, 0.8}, {0.5, 0.2, 0.1});
    const PointList points = Doubles(WholeSurface(can, 1500));
    const PrincipalBox box = ComputePrincipalBox(points);
    EXPECT_EQ(SymmetryAxis(box), a.z() > a.x() ? 0 : 2);
    const MethodOutcome fit = FitClassic(points, {});
    EXPECT_GT(std::abs(fit.shape.X_FO.linear().col(2).dot(can.X_FO.linear().col(2))), 0.999);
    EXPECT_NEAR(fit.shape.epsilon[1], 1, 0.05);
  }
}

TEST(Classic, FitsTaperOnlyWhereItIsAllowed) {
  Superquadric truth = MakeShape({0.03, 0.04, 0.09}, 0.3, 0.8, {0, 0, 0.8});
  truth.taper = {0.3, 0.3};
  const PointList points = Doubles(WholeSurface(truth, 1500));
  ClassicConfig config;
  const MethodOutcome straight = FitClassic(points, config);
  EXPECT_TRUE(straight.shape.taper.isZero(0));
  config.max_taper = 0.5;
  config.max_iterations = 100;
  const MethodOutcome tapered = FitClassic(points, config);
  EXPECT_NEAR(tapered.shape.taper.cwiseAbs().minCoeff(), 0.3, 0.05);
  EXPECT_LT(MeanRadialDistance(tapered.shape, points),
            0.5 * MeanRadialDistance(straight.shape, points));
}

TEST(Classic, StaysWithinThePointsExtent) {
  const Superquadric box = MakeShape({0.04, 0.06, 0.09}, 0.1, 0.1, {0, 0, 0.09}, {0, 0, 0.5});
  const PointList points = Doubles(ViewOnTable(box, 3000, 0.0015).points_C);
  const double largest = ComputePrincipalBox(points).half_extents.maxCoeff();
  ClassicConfig config;
  config.max_iterations = 1000;
  const MethodOutcome fit = FitClassic(points, config);
  EXPECT_LE(fit.shape.semi_axes.maxCoeff(), largest + config.axis_margin_m + 1e-9);
  EXPECT_LE(fit.iterations[0], config.max_iterations);
}

}  // namespace
}  // namespace beckon::pose
