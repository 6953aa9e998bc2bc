// The superquadric's functions against known answers and finite differences.
#include "services/pose/superquadric.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "services/pose/fit_stage.h"
#include "services/pose/levenberg_marquardt.h"
#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

using Eigen::Vector3d;

const std::vector<double> kExponents{0.05, 0.1, 0.3, 0.5, 1.0, 1.5, 1.9, 2.0};

TEST(Gauge, IsOneOnASphereAndGrowsLinearlyWithDistance) {
  const Superquadric sphere = MakeShape(Vector3d::Constant(0.05), 1, 1);
  EXPECT_NEAR(Gauge(sphere, {0.03, 0.04, 0}), 1, 1e-12);
  EXPECT_NEAR(Gauge(sphere, {0, 0, 0.1}), 2, 1e-12);
  EXPECT_EQ(Gauge(sphere, Vector3d::Zero()), 0);
}

TEST(Gauge, IsTheInsideOutsideFunctionToThePowerOfHalfEpsilon) {
  const Superquadric s = MakeShape({0.03, 0.05, 0.08}, 0.7, 1.3);
  const Vector3d p(0.02, -0.03, 0.05);
  const double xy = std::pow(0.02 / 0.03, 2 / 1.3) + std::pow(0.03 / 0.05, 2 / 1.3);
  const double F = std::pow(xy, 1.3 / 0.7) + std::pow(0.05 / 0.08, 2 / 0.7);
  EXPECT_NEAR(Gauge(s, p), std::pow(F, 0.35), 1e-12);
}

TEST(Gauge, IsFiniteForEveryExponentAndPoint) {
  for (double e1 : kExponents) {
    for (double e2 : kExponents) {
      const Superquadric s = MakeShape({0.01, 0.05, 0.12}, e1, e2);
      for (const Vector3d& p : {Vector3d(0, 0, 0), Vector3d(0.01, 0, 0), Vector3d(0, 0, 1e-9),
                                Vector3d(1e3, -1e3, 1e3), Vector3d(1e-12, 1e-12, 1e-12)}) {
        const GaugeDerivatives d = DifferentiateGauge(s, p);
        EXPECT_TRUE(std::isfinite(d.log_g) && d.point.allFinite() && d.epsilon.allFinite());
        EXPECT_TRUE(d.log_semi_axes.allFinite() && d.taper.allFinite());
      }
    }
  }
}

TEST(Gauge, JacobianAgreesWithFiniteDifferences) {
  constexpr double kStep = 1e-6;
  FitBounds wide;
  wide.min_epsilon = kMinEpsilon;
  wide.max_epsilon = kMaxEpsilon;
  wide.max_taper = 1;
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (double e1 : {0.06, 0.1, 0.5, 1.0, 1.9}) {
    for (double e2 : {0.06, 0.3, 1.0, 1.7}) {
      Superquadric s = MakeShape({0.04, 0.06, 0.09}, e1, e2, {0.3, -0.1, 0.9}, {0.4, -0.7, 0.2});
      s.taper = {0.2, -0.1};
      const Vector3d p =
          s.X_FO * Vector3d(0.1 * unit(engine), 0.1 * unit(engine), 0.1 * unit(engine));
      ParameterVector analytic;
      const GaugeDerivatives d = DifferentiateGauge(s, s.X_FO.inverse() * p);
      FillJacobian(s, p - s.X_FO.translation(), d, 1, 1, analytic);
      for (int i = 0; i < kParameters; ++i) {
        ParameterVector step = ParameterVector::Zero();
        step[i] = kStep;
        const auto log_g = [&](const ParameterVector& by) {
          const Superquadric moved = Move(s, by, wide);
          return std::log(Gauge(moved, moved.X_FO.inverse() * p));
        };
        const double numeric = (log_g(step) - log_g(-step)) / (2 * kStep);
        EXPECT_NEAR(analytic[i], numeric, 1e-4 * (1 + std::abs(numeric)))
            << "parameter " << i << ", e1 " << e1 << ", e2 " << e2;
      }
    }
  }
}

TEST(SurfaceDistance, IsExactForASphere) {
  const Superquadric sphere = MakeShape(Vector3d::Constant(0.05), 1, 1, {0.1, 0.2, 0.3});
  const SurfaceDistance d = DistanceToSurface(sphere, Vector3d(0.1, 0.2, 0.3 + 0.06));
  EXPECT_NEAR(d.distance_m, 0.01, 1e-12);
  EXPECT_NEAR(d.jacobian[kTranslation + 2], -1, 1e-9);
  EXPECT_NEAR(d.jacobian.head<3>().sum(), -0.05, 1e-9);  // growing by a part of its size
  EXPECT_NEAR(RadialDistance(sphere, {0.1, 0.2, 0.3 + 0.04}), 0.01, 1e-12);
}

TEST(Support, TouchesTheSurfaceAndBoundsIt) {
  for (double e1 : {0.1, 0.5, 1.0, 1.6}) {
    for (double e2 : {0.1, 0.8, 1.0, 1.6}) {
      const Superquadric s = MakeShape({0.03, 0.05, 0.08}, e1, e2);
      const Vector3d n = Vector3d(0.3, -0.5, 0.6).normalized();
      const SupportDerivatives d = DifferentiateSupport(s, n);
      EXPECT_NEAR(Gauge(s, d.point), 1, 1e-9);
      EXPECT_NEAR(n.dot(d.point), d.h, 1e-12);
      for (const auto& p : SampleSurface(s, 500)) EXPECT_LE(n.dot(p), d.h + 1e-9);
    }
  }
}

TEST(Support, DerivativesAgreeWithFiniteDifferences) {
  constexpr double kStep = 1e-6;
  const Superquadric s = MakeShape({0.03, 0.05, 0.08}, 0.4, 0.9);
  const Vector3d n = Vector3d(0.3, -0.5, 0.6).normalized();
  const SupportDerivatives d = DifferentiateSupport(s, n);
  for (int i = 0; i < 3; ++i) {
    Superquadric more = s, less = s;
    more.semi_axes[i] *= std::exp(kStep);
    less.semi_axes[i] *= std::exp(-kStep);
    const double by_axis = (DifferentiateSupport(more, n).h - DifferentiateSupport(less, n).h);
    EXPECT_NEAR(d.log_semi_axes[i], by_axis / (2 * kStep), 1e-7);
  }
  for (int i = 0; i < 2; ++i) {
    Superquadric more = s, less = s;
    more.epsilon[i] += kStep;
    less.epsilon[i] -= kStep;
    const double by_e = (DifferentiateSupport(more, n).h - DifferentiateSupport(less, n).h);
    EXPECT_NEAR(d.epsilon[i], by_e / (2 * kStep), 1e-7);
  }
}

TEST(Surface, SamplesLieOnItWithAndWithoutTaper) {
  for (double e1 : {0.05, 0.3, 1.0, 2.0}) {
    for (double e2 : {0.05, 0.3, 1.0, 2.0}) {
      Superquadric s = MakeShape({0.02, 0.06, 0.11}, e1, e2, {1, 2, 3}, {0.3, 0.2, -0.9});
      for (const Eigen::Vector2d& taper : {Eigen::Vector2d(0, 0), Eigen::Vector2d(0.3, -0.2)}) {
        s.taper = taper;
        const auto points = SampleSurface(s, 200);
        ASSERT_EQ(points.size(), 200u);
        for (const auto& p : points) EXPECT_NEAR(Gauge(s, s.X_FO.inverse() * p), 1, 1e-6);
      }
    }
  }
}

TEST(Surface, SamplesSpreadOverASphereEvenly) {
  int upper = 0, eighth = 0;
  for (const auto& p : SampleSurface(MakeShape(Vector3d::Ones(), 1, 1), 800)) {
    upper += p.z() > 0;
    eighth += p.x() > 0 && p.y() > 0 && p.z() > 0;
  }
  EXPECT_NEAR(upper, 400, 4);
  EXPECT_NEAR(eighth, 100, 6);
}

TEST(Volume, HasItsKnownAnswers) {
  const Vector3d a(0.02, 0.03, 0.05);
  EXPECT_NEAR(Volume(MakeShape(a, 1, 1)), 4.0 / 3 * std::numbers::pi * a.prod(), 1e-12);
  EXPECT_NEAR(Volume(MakeShape(a, 0.02, 0.02)), 8 * a.prod(), 0.001 * a.prod() * 8);
  EXPECT_NEAR(Volume(MakeShape(a, 0.02, 1)), 2 * std::numbers::pi * a.prod(), 0.001 * a.prod() * 8);
  EXPECT_NEAR(Volume(MakeShape(a, 2, 2)), 4.0 / 3 * a.prod(), 1e-12);  // octahedron
}

TEST(Volume, OfATaperedShapeAgreesWithCounting) {
  Superquadric s = MakeShape({1, 1, 1}, 0.5, 0.8);
  s.taper = {0.5, 0.4};
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> unit(-1.5, 1.5);
  int inside = 0;
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    const Vector3d p(unit(engine), unit(engine), unit(engine));
    inside += std::abs(p.z()) < 1 && Gauge(s, p) < 1;
  }
  EXPECT_NEAR(Volume(s), 27.0 * inside / kCount, 0.05);
}

TEST(ShapeDifference, SeesShapesNotParameters) {
  const Superquadric box = MakeShape({0.03, 0.05, 0.08}, 0.1, 0.1);
  const Superquadric same =
      MakeShape({0.05, 0.03, 0.08}, 0.1, 0.1, Vector3d::Zero(), {0, 0, std::numbers::pi / 2});
  EXPECT_LT(ShapeDifference(box, same), 1e-6);
  EXPECT_GT(ShapeDifference(box, MakeShape({0.03, 0.05, 0.05}, 0.1, 0.1)), 0.003);
}

}  // namespace
}  // namespace beckon::pose
