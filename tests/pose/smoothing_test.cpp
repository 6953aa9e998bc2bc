// Moving least squares: less noise, and no harm to curved surfaces or lone points.
#include "services/pose/smoothing.h"

#include <gtest/gtest.h>

#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

TEST(Smoothing, TakesNoiseOffACurvedSurface) {
  const Superquadric ball = MakeShape({0.06, 0.06, 0.06}, 1, 1, {0, 0, 0.8});
  PointList noisy;
  for (const auto& p : WholeSurface(ball, 1500, 0.002)) noisy.push_back(p.cast<double>());
  const PointList smooth = SmoothedByMovingLeastSquares(noisy, 0.03);
  ASSERT_EQ(smooth.size(), noisy.size());
  EXPECT_LT(MeanRadialDistance(ball, smooth), 0.5 * MeanRadialDistance(ball, noisy));
}

TEST(Smoothing, LeavesLonePointsWhereTheyAre) {
  const PointList points{{0, 0, 1}, {0.001, 0, 1}, {5, 0, 1}};
  EXPECT_EQ(SmoothedByMovingLeastSquares(points, 0.03), points);
}

}  // namespace
}  // namespace beckon::pose
