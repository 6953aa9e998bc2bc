// A few points that stand for many.
#include "services/pose/even_spread.h"

#include <gtest/gtest.h>

#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

using Eigen::Vector3d;

PointList Widened(const std::vector<Eigen::Vector3f>& points) {
  PointList wide;
  for (const auto& p : points) wide.push_back(p.cast<double>());
  return wide;
}

// A square of `size_m` at a height, points half a millimetre apart.
PointList Square(double size_m, double height_m) {
  PointList points;
  const int n = static_cast<int>(size_m / 0.0005);
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) points.emplace_back(0.0005 * i, 0.0005 * k, height_m);
  }
  return points;
}

TEST(EvenSpread, ComesNearTheCountThatIsWanted) {
  for (const Vector3d& axes : {Vector3d(0.04, 0.06, 0.09), Vector3d(0.01, 0.02, 0.15)}) {
    for (const double e : {0.1, 1.0}) {
      const PointList points = Widened(WholeSurface(MakeShape(axes, e, e, {0, 0, 0.8}), 8000));
      for (const int count : {60, 300, 500}) {
        const SpreadPoints spread = SpreadEvenly(points, count);
        EXPECT_GT(spread.points.size(), 0.6 * count);
        EXPECT_LT(spread.points.size(), 1.6 * count);
        EXPECT_EQ(spread.weights.size(), spread.points.size());
      }
    }
  }
}

TEST(EvenSpread, IsEvenWhereThePointsAreNot) {
  // One half of a square four times as dense as the other.
  PointList points = Square(0.1, 0.8);
  std::erase_if(points,
                [n = 0](const Vector3d& p) mutable { return p.x() > 0.05 && n++ % 4 != 0; });
  const SpreadPoints spread = SpreadEvenly(points, 200);
  int left = 0, right = 0;
  for (const auto& p : spread.points) ++(p.x() > 0.05 ? right : left);
  EXPECT_NEAR(static_cast<double>(left) / right, 1, 0.25);
}

TEST(EvenSpread, WeighsFlyingPixelsLess) {
  PointList points = Square(0.1, 0.8);
  const size_t dense = points.size();
  for (int i = 0; i < 40; ++i) points.emplace_back(0.0025 * i, 0.11, 0.83);  // a thin row
  ASSERT_GT(dense, 10000u);
  const SpreadPoints spread = SpreadEvenly(points, 300);
  double lightest = 1, heaviest_flying = 0;
  for (size_t i = 0; i < spread.points.size(); ++i) {
    EXPECT_GT(spread.weights[i], 0);
    EXPECT_LE(spread.weights[i], 1);
    const Vector3d& p = spread.points[i];
    if (p.z() > 0.81) heaviest_flying = std::max(heaviest_flying, spread.weights[i]);
    const bool inner = p.head<2>().minCoeff() > 0.01 && p.head<2>().maxCoeff() < 0.09;
    if (p.z() < 0.81 && inner) lightest = std::min(lightest, spread.weights[i]);
  }
  EXPECT_GT(heaviest_flying, 0);
  EXPECT_LT(heaviest_flying, 0.5);
  EXPECT_EQ(lightest, 1);
}

TEST(EvenSpread, KeepsAllPointsWhereTheyAreFew) {
  const PointList points = Widened(WholeSurface(MakeShape({0.04, 0.06, 0.09}, 1, 1), 300));
  const SpreadPoints spread = SpreadEvenly(points, 300);
  EXPECT_EQ(spread.points, points);
  EXPECT_EQ(spread.weights, std::vector<double>(300, 1.0));
}

TEST(EvenSpread, IsTheSameEveryTime) {
  const PointList points =
      Widened(WholeSurface(MakeShape({0.04, 0.06, 0.09}, 0.3, 1), 5000, 0.001));
  const SpreadPoints a = SpreadEvenly(points, 300), b = SpreadEvenly(points, 300);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.weights, b.weights);
}

TEST(EvenSpread, WithstandsPointsInOnePlace) {
  const PointList points(1000, Vector3d(0.1, 0.2, 0.8));
  const SpreadPoints spread = SpreadEvenly(points, 100);
  ASSERT_EQ(spread.points.size(), 1u);
  EXPECT_LT((spread.points[0] - points[0]).norm(), 1e-9);
}

}  // namespace
}  // namespace beckon::pose
