// The gauge, the distances and the support function against known answers and finite differences.
#include "services/pose/superquadric.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>

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

// Calls check(shape) for shapes of all exponents.
template <typename Check>
void ForAllExponents(const Vector3d& semi_axes, const Check& check) {
  for (double e1 : kExponents) {
    for (double e2 : kExponents) {
      SCOPED_TRACE("e " + std::to_string(e1) + ' ' + std::to_string(e2));
      check(MakeShape(semi_axes, e1, e2));
    }
  }
}

TEST(Gauge, IsFiniteForEveryExponentAndPoint) {
  ForAllExponents({0.01, 0.05, 0.12}, [](const Superquadric& s) {
    for (const Vector3d& p : {Vector3d(0, 0, 0), Vector3d(0.01, 0, 0), Vector3d(0, 0, 1e-9),
                              Vector3d(1e3, -1e3, 1e3), Vector3d(1e-12, 1e-12, 1e-12)}) {
      const GaugeDerivatives d = DifferentiateGauge(s, p);
      EXPECT_TRUE(std::isfinite(d.log_g) && d.point.allFinite() && d.epsilon.allFinite());
      EXPECT_TRUE(d.log_semi_axes.allFinite() && d.taper.allFinite());
    }
  });
}

// The inside-outside function as Solina & Bajcsy write it, in arithmetic wide enough for its
// powers.
long double WideLogGauge(const Superquadric& s, const std::array<long double, 3>& p) {
  const long double e1 = s.epsilon[0], e2 = s.epsilon[1];
  const auto part = [&](int i) {
    const long double height = p[2] / s.semi_axes[2];
    const long double taper = i < 2 ? s.taper[i] * height + 1 : 1;
    return std::abs(p[static_cast<size_t>(i)]) / (s.semi_axes[i] * taper);
  };
  const long double xy = std::pow(part(0), 2 / e2) + std::pow(part(1), 2 / e2);
  return e1 / 2 * std::log(std::pow(xy, e2 / e1) + std::pow(part(2), 2 / e1));
}

// Points with coordinates of 1e-9 to 1e3 semi-axes, each of its own size.
class WidePoints {
 public:
  Vector3d Next(const Superquadric& s) {
    Vector3d p;
    for (int i = 0; i < 3; ++i) {
      p[i] = std::pow(10, exponent_(engine_)) * s.semi_axes[i] * (engine_() % 2 == 0 ? 1 : -1);
    }
    return p;
  }

 private:
  std::mt19937 engine_{11};
  std::uniform_real_distribution<double> exponent_{-9, 3};
};

// Calls check(shape, point) for shapes of all exponents and 50 points each.
template <typename Check>
void ForWidePoints(const Vector3d& semi_axes, const Check& check) {
  WidePoints points;
  ForAllExponents(semi_axes, [&](const Superquadric& s) {
    for (int i = 0; i < 50; ++i) check(s, points.Next(s));
  });
}

TEST(Gauge, AgreesWithTheInsideOutsideFunctionInWideArithmetic) {
  ForWidePoints({0.01, 0.05, 0.12}, [](const Superquadric& s, const Vector3d& p) {
    const auto expected = static_cast<double>(WideLogGauge(s, {p[0], p[1], p[2]}));
    EXPECT_NEAR(DifferentiateGauge(s, p).log_g, expected, 1e-13 * (1 + std::abs(expected)))
        << "at " << p.transpose();
  });
}

// Central differences in wide arithmetic, with a step of a millionth of each coordinate.
Vector3d WideGradient(const Superquadric& s, const Vector3d& p) {
  Vector3d gradient;
  for (int i = 0; i < 3; ++i) {
    std::array<long double, 3> more{p[0], p[1], p[2]}, less = more;
    const long double step = 1e-6L * p[i];
    more[static_cast<size_t>(i)] += step;
    less[static_cast<size_t>(i)] -= step;
    gradient[i] = static_cast<double>((WideLogGauge(s, more) - WideLogGauge(s, less)) / (2 * step));
  }
  return gradient;
}

TEST(Gauge, GradientKeepsTheDigitsOfItsSmallComponents) {
  ForWidePoints({0.01, 0.05, 0.12}, [](const Superquadric& s, const Vector3d& p) {
    const Vector3d gradient = DifferentiateGauge(s, p).point, expected = WideGradient(s, p);
    for (int k = 0; k < 3; ++k) {
      // What the differences themselves can tell: log g to 1e-18 over a step of 1e-6 p.
      const double resolution = 1e-10 / std::abs(p[k]);
      EXPECT_NEAR(gradient[k], expected[k], 1e-6 * std::abs(expected[k]) + resolution)
          << "at " << p.transpose();
    }
  });
}

TEST(Gauge, GradientOfATaperedShapeAgreesWithFiniteDifferences) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  ForAllExponents({0.03, 0.05, 0.12}, [&](Superquadric s) {
    s.taper = {0.6, -0.4};
    for (int i = 0; i < 20; ++i) {
      const Vector3d p = Vector3d(unit(engine), unit(engine), unit(engine)) * 0.12;
      const Vector3d gradient = DifferentiateGauge(s, p).point, expected = WideGradient(s, p);
      EXPECT_LT((gradient - expected).norm(), 1e-6 * expected.norm()) << "at " << p.transpose();
    }
  });
}

TEST(Gauge, SlopeAcrossAPlaneOfSymmetryIsZero) {
  for (double e : kExponents) {
    const Superquadric s = MakeShape({0.03, 0.05, 0.08}, e, e);
    EXPECT_EQ(NormalAt(s, {0.03, 0, 0}), Vector3d::UnitX()) << e;
    EXPECT_EQ(NormalAt(s, {0, -0.05, 0}), -Vector3d::UnitY()) << e;
    EXPECT_EQ(NormalAt(s, {0, 0, 0.08}), Vector3d::UnitZ()) << e;
    EXPECT_EQ(NormalAt(s, {0.02, -0.04, 0}).z(), 0) << e;
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

TEST(Support, IsExactForAllExponentsAndDirections) {
  ForWidePoints({0.03, 0.05, 0.08}, [](const Superquadric& s, const Vector3d& direction) {
    const Vector3d n = direction.normalized();
    const SupportDerivatives d = DifferentiateSupport(s, n);
    EXPECT_NEAR(n.dot(d.point), d.h, 1e-14);
    EXPECT_NEAR(Gauge(s, d.point), 1, 1e-8);
  });
}

TEST(Support, AlongAnAxisIsTheMiddleOfTheFace) {
  for (double e : {0.05, 0.5, 1.0, 1.9}) {
    const Superquadric s = MakeShape({0.03, 0.05, 0.08}, e, e);
    for (int i = 0; i < 3; ++i) {
      const SupportDerivatives d = DifferentiateSupport(s, Vector3d::Unit(i));
      EXPECT_NEAR(d.h, s.semi_axes[i], 1e-15);
      EXPECT_LT((d.point - s.semi_axes[i] * Vector3d::Unit(i)).norm(), 1e-15);
    }
  }
}

TEST(Support, OfAnOctahedronIsThatOfItsVertices) {
  const Superquadric s = MakeShape({0.03, 0.05, 0.08}, 2, 2);
  for (const Vector3d& n : {Vector3d(1, 2, 3), Vector3d(5, -3, 1), Vector3d(0, 1, -0.1)}) {
    const double expected = n.cwiseAbs().cwiseProduct(s.semi_axes).maxCoeff();
    EXPECT_NEAR(DifferentiateSupport(s, n).h, expected, 1e-9);
  }
  // Two vertices at once: any point of the edge between them supports.
  const Vector3d edge(1 / 0.03, 1 / 0.05, 0);
  EXPECT_NEAR(DifferentiateSupport(s, edge).h, 1, 1e-8);
}

TEST(HalfWidth, BoundsATaperedShape) {
  Superquadric s = MakeShape({0.03, 0.05, 0.08}, 0.3, 0.6, {0.1, 0.2, 0.3}, {0.5, -0.3, 0.8});
  s.taper = {0.7, -0.5};
  for (const Vector3d& axis : {Vector3d(1, 0, 0), Vector3d(1, 2, -1), Vector3d(0, 1, 3)}) {
    const Vector3d n = axis.normalized();
    double most = 0;
    for (const auto& p : SampleSurface(s, 2000)) {
      most = std::max(most, std::abs(n.dot(p - s.X_FO.translation())));
    }
    EXPECT_LE(most, HalfWidth(s, n));
    EXPECT_GT(most, 0.5 * HalfWidth(s, n));
  }
}

TEST(RadialDistance, IsExactAlongTheRayAlsoForTaperedShapes) {
  std::mt19937 engine(9);
  std::uniform_real_distribution<double> log_factor(-6, 6);
  for (double e1 : kExponents) {
    for (double e2 : kExponents) {
      Superquadric s = MakeShape({0.03, 0.05, 0.08}, e1, e2, {1, 2, 3}, {0.3, 0.2, -0.9});
      for (const Eigen::Vector2d& taper :
           {Eigen::Vector2d(0, 0), Eigen::Vector2d(0.3, -0.2), Eigen::Vector2d(-0.99, 0.99)}) {
        s.taper = taper;
        for (const auto& p : SampleSurface(s, 40)) {
          const Vector3d arm = p - s.X_FO.translation();
          const double factor = std::exp(log_factor(engine));
          EXPECT_NEAR(RadialDistance(s, s.X_FO.translation() + factor * arm),
                      std::abs(factor - 1) * arm.norm(), 1e-8 * (1 + factor))
              << "e " << e1 << ' ' << e2 << " taper " << taper.transpose() << " at "
              << (s.X_FO.inverse() * p).transpose();
        }
      }
    }
  }
}

TEST(RadialDistance, OfTheCentreIsTheSmallestSemiAxis) {
  const Superquadric s = MakeShape({0.03, 0.05, 0.08}, 0.1, 1, {1, 2, 3});
  EXPECT_EQ(RadialDistance(s, {1, 2, 3}), 0.03);
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

}  // namespace
}  // namespace beckon::pose
