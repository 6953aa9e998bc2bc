// The kernels in single precision against the same quantities in double.
#include "services/pose/distance_kernel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "services/pose/fit_stage.h"
#include "services/pose/levenberg_marquardt.h"
#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

using Eigen::Vector3d;

class Draws {
 public:
  explicit Draws(unsigned seed) : engine_(seed) {}
  double Uniform(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(engine_);
  }
  Vector3d Direction() {
    std::normal_distribution<double> normal(0, 1);
    return Vector3d(normal(engine_), normal(engine_), normal(engine_)).normalized();
  }
  Superquadric Shape(double min_epsilon, double max_epsilon) {
    const auto axis = [&] { return Uniform(0.01, 0.15); };
    return MakeShape({axis(), axis(), axis()}, Uniform(min_epsilon, max_epsilon),
                     Uniform(min_epsilon, max_epsilon), 0.3 * Direction() + Vector3d(0, 0, 0.9),
                     Uniform(0, 3) * Direction());
  }
  /// A point whose gauge is drawn from a range.
  Vector3d PointOf(const Superquadric& shape, double min_gauge, double max_gauge) {
    const Vector3d p_O = shape.semi_axes.cwiseProduct(Direction());
    return shape.X_FO * (p_O * (Uniform(min_gauge, max_gauge) / Gauge(shape, p_O)));
  }
  PointBlock Block(const Superquadric& shape, int count, double min_gauge, double max_gauge) {
    PointBlock block;
    for (int i = 0; i < count; ++i) {
      block.Add(PointOf(shape, min_gauge, max_gauge), Uniform(0, 1));
    }
    block.Pad();
    return block;
  }

 private:
  std::mt19937 engine_;
};

double WeightOf(const PointBlock& block, int i) {
  return static_cast<double>(block.weight[static_cast<size_t>(i)]);
}

double CauchyCost(double distance, CauchyLoss loss) {
  const double s = distance < 0 ? loss.inside_m : loss.outside_m;
  return s * s * std::log1p(distance * distance / (s * s));
}

double CostInDouble(const Superquadric& shape, const PointBlock& block, CauchyLoss loss) {
  double cost = 0;
  for (int i = 0; i < block.size; ++i) {
    cost += WeightOf(block, i) * CauchyCost(DistanceToSurface(shape, block.at(i)).distance_m, loss);
  }
  return cost;
}

TEST(DistanceKernel, HasTheDistancesOfDoublePrecision) {
  Draws draws(1);
  for (int trial = 0; trial < 300; ++trial) {
    const Superquadric shape = draws.Shape(0.05, 1.9);
    const PointBlock block = draws.Block(shape, 37, 0.2, 3);
    BlockDistances distances;
    ComputeDistances(shape, block, distances);
    for (int i = 0; i < block.size; ++i) {
      const double expected = DistanceToSurface(shape, block.at(i)).distance_m;
      EXPECT_NEAR(static_cast<double>(distances[static_cast<size_t>(i)]), expected,
                  2e-6 + 1e-3 * std::abs(expected))
          << "epsilon " << shape.epsilon.transpose();
    }
  }
}

TEST(DistanceKernel, SumsWhatDoublePrecisionSums) {
  constexpr CauchyLoss kLoss{0.0006, 0.003};
  Draws draws(2);
  for (int trial = 0; trial < 200; ++trial) {
    const Superquadric shape = draws.Shape(0.1, 1);
    const PointBlock block = draws.Block(shape, 100, 0.7, 1.4);
    const DistanceSum sum = SumDistances(shape, block, kLoss);
    EXPECT_NEAR(sum.cost / CostInDouble(shape, block, kLoss), 1, 1e-3);
    Eigen::Matrix<double, kKernelParameters, 1> gradient, size;
    Eigen::Matrix<double, kKernelParameters, kKernelParameters> hessian;
    gradient.setZero();
    size.setZero();
    hessian.setZero();
    for (int i = 0; i < block.size; ++i) {
      const SurfaceDistance d = DistanceToSurface(shape, block.at(i));
      const double s = d.distance_m < 0 ? kLoss.inside_m : kLoss.outside_m;
      const double weight = WeightOf(block, i) / (1 + d.distance_m * d.distance_m / (s * s));
      const auto J = d.jacobian.head<kKernelParameters>();
      gradient += weight * d.distance_m * J;
      size += (weight * d.distance_m * J).cwiseAbs();
      hessian += weight * J * J.transpose();
    }
    for (int k = 0; k < kKernelParameters; ++k) {
      EXPECT_NEAR(sum.gradient[k], gradient[k], 2e-3 * size[k] + 1e-9) << "parameter " << k;
      for (int m = 0; m < kKernelParameters; ++m) {
        EXPECT_NEAR(sum.hessian(k, m), hessian(k, m),
                    2e-3 * std::sqrt(hessian(k, k) * hessian(m, m)) + 1e-9);
      }
    }
  }
}

TEST(DistanceKernel, GradientIsTheSlopeOfTheCostNearTheSurface) {
  constexpr CauchyLoss kLoss{0.002, 0.002};
  constexpr double kStep = 1e-5;
  const FitBounds free{Vector3d::Constant(1e-6), Vector3d::Constant(10), 0.02, 2, 0};
  Draws draws(3);
  for (int trial = 0; trial < 100; ++trial) {
    const Superquadric shape = draws.Shape(0.3, 1);
    const PointBlock block = draws.Block(shape, 64, 0.9995, 1.0005);
    const DistanceSum sum = SumDistances(shape, block, kLoss);
    for (int k = 0; k < kKernelParameters; ++k) {
      const ParameterVector step = kStep * ParameterVector::Unit(k);
      const double slope = (CostInDouble(Move(shape, step, free), block, kLoss) -
                            CostInDouble(Move(shape, -step, free), block, kLoss)) /
                           (2 * kStep);
      // In a mean square sense: J^T W r against sqrt(J^T W J) sqrt(r^T W r).
      const double scale = std::sqrt(sum.hessian(k, k) * sum.cost);
      EXPECT_NEAR(2 * sum.gradient[k], slope, 0.05 * scale + 1e-9) << "parameter " << k;
    }
  }
}

TEST(DistanceKernel, PaddingDoesNotCount) {
  Draws draws(4);
  const Superquadric shape = draws.Shape(0.3, 1);
  PointBlock block = draws.Block(shape, 5, 0.8, 1.2), longer = block;
  const DistanceSum sum = SumDistances(shape, block, {0.002, 0.002});
  EXPECT_EQ(block.size, 5);
  for (int i = 0; i < 3; ++i) longer.Add(draws.PointOf(shape, 2, 3), 0);
  longer.Pad();
  const DistanceSum with_weightless = SumDistances(shape, longer, {0.002, 0.002});
  EXPECT_EQ(sum.cost, with_weightless.cost);
  EXPECT_EQ(sum.gradient, with_weightless.gradient);
  EXPECT_EQ(SumRadialDistances(shape, block), SumRadialDistances(shape, longer));
  // Beyond the padding nothing is read.
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  for (size_t i = 8; i < 16; ++i) block.x[i] = block.weight[i] = kNan;
  EXPECT_EQ(SumDistances(shape, block, {0.002, 0.002}).cost, sum.cost);
}

TEST(DistanceKernel, StaysFiniteInTheCentreAndFarAway) {
  for (const double e : {0.1, 1.0}) {
    const Superquadric shape = MakeShape({0.03, 0.05, 0.08}, e, e, {0, 0, 1});
    PointBlock block;
    for (const Vector3d& p : {Vector3d(0, 0, 1), Vector3d(0.03, 0, 1), Vector3d(0, 0, 1e6),
                              Vector3d(1e-30, 1e-30, 1)}) {
      block.Add(p, 1);
    }
    block.Pad();
    const DistanceSum sum = SumDistances(shape, block, {0.002, 0.002});
    EXPECT_TRUE(std::isfinite(sum.cost) && sum.gradient.allFinite() && sum.hessian.allFinite());
    EXPECT_TRUE(std::isfinite(SumRadialDistances(shape, block)));
  }
}

TEST(DistanceKernel, SumsRadialDistances) {
  Draws draws(5);
  for (int trial = 0; trial < 200; ++trial) {
    const Superquadric shape = draws.Shape(0.05, 1.9);
    const PointBlock block = draws.Block(shape, 61, 0.2, 3);
    double expected = 0;
    for (int i = 0; i < block.size; ++i) {
      expected += WeightOf(block, i) * RadialDistance(shape, block.at(i));
    }
    EXPECT_NEAR(SumRadialDistances(shape, block) / expected, 1, 1e-4);
  }
}

// The least gauge along a ray, in double.
double LeastGauge(const Superquadric& shape, const Vector3d& ray) {
  const double middle = shape.X_FO.translation().dot(ray), reach = shape.semi_axes.norm();
  const Pose X_OF = shape.X_FO.inverse();
  double lo = middle - reach, hi = middle + reach;
  for (int i = 0; i < 80; ++i) {  // ternary search: the gauge is convex
    const double t1 = lo + (hi - lo) / 3, t2 = hi - (hi - lo) / 3;
    (Gauge(shape, X_OF * (t1 * ray)) < Gauge(shape, X_OF * (t2 * ray)) ? hi : lo) =
        Gauge(shape, X_OF * (t1 * ray)) < Gauge(shape, X_OF * (t2 * ray)) ? t2 : t1;
  }
  return Gauge(shape, X_OF * (0.5 * (lo + hi) * ray));
}

TEST(DistanceKernel, FindsWhereRaysAreDeepest) {
  Draws draws(6);
  for (int trial = 0; trial < 100; ++trial) {
    const Superquadric shape = draws.Shape(0.1, 1);
    PointBlock rays, coarse, fine;
    for (int i = 0; i < 21; ++i) rays.Add(draws.PointOf(shape, 0.3, 1).normalized(), 1);
    rays.Pad();
    FindDeepest(shape, Vector3d::Zero(), rays, 13, coarse);
    FindDeepest(shape, Vector3d::Zero(), rays, 30, fine);
    const Pose X_OF = shape.X_FO.inverse();
    for (int i = 0; i < rays.size; ++i) {
      const double least = LeastGauge(shape, rays.at(i));
      EXPECT_NEAR(Gauge(shape, X_OF * fine.at(i)), least, 1e-4);
      // The place is known to 0.618^13 of twice the reach, half of that either way.
      const double off_m = std::pow(0.618, 13) * shape.semi_axes.norm();
      EXPECT_NEAR(Gauge(shape, X_OF * coarse.at(i)), least,
                  off_m / shape.semi_axes.minCoeff() + 1e-4);
      EXPECT_LT(fine.at(i).normalized().cross(rays.at(i)).norm(), 1e-6);  // on its ray
    }
    for (int i = 0; i < rays.size; ++i) EXPECT_EQ(WeightOf(fine, i), 1);
  }
}

TEST(DistanceKernel, GivesTheSameBytesEveryTime) {
  Draws draws(7);
  const Superquadric shape = draws.Shape(0.1, 1);
  const PointBlock block = draws.Block(shape, 300, 0.5, 2);
  const DistanceSum a = SumDistances(shape, block, {0.001, 0.002});
  const DistanceSum b = SumDistances(shape, block, {0.001, 0.002});
  EXPECT_EQ(std::memcmp(&a.cost, &b.cost, sizeof a.cost), 0);
  EXPECT_EQ(std::memcmp(a.gradient.data(), b.gradient.data(), sizeof(double) * 11), 0);
  EXPECT_EQ(std::memcmp(a.hessian.data(), b.hessian.data(), sizeof(double) * 121), 0);
}

}  // namespace
}  // namespace beckon::pose
