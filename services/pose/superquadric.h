// Superquadric: the inside-outside function, its gradients and the support function, all in log
// space.
#pragma once

#include <Eigen/Core>

#include "services/base/geometry.h"

namespace beckon::pose {

/// Smallest and largest shape exponent that the functions below are exact for.
inline constexpr double kMinEpsilon = 0.02;
inline constexpr double kMaxEpsilon = 2.0;

/// A superquadric in some frame F. Its surface, in its own frame O, is (Solina & Bajcsy 1990, eq.
/// 1)
///   F(x, y, z) = ((x/a1)^(2/e2) + (y/a2)^(2/e2))^(e2/e1) + (z/a3)^(2/e1) = 1,
/// with linear tapering along z (their eq. 19): a point of the straight shape is moved to
/// x (kx z/a3 + 1), y (ky z/a3 + 1), z.
struct Superquadric {
  Eigen::Vector3d semi_axes = Eigen::Vector3d::Ones();  // m, a1 a2 a3, > 0
  Eigen::Vector2d epsilon = Eigen::Vector2d::Ones();    // e1 e2, kMinEpsilon .. kMaxEpsilon
  Eigen::Vector2d taper = Eigen::Vector2d::Zero();      // kx ky, -1 .. 1
  Pose X_FO = Pose::Identity();
};

/// log g and its derivatives at a point, g being the gauge: g(s p) = s g(p), g = 1 on the surface,
/// and F = g^(2/e1). Without taper g is a norm for exponents up to 2.
struct GaugeDerivatives {
  double log_g = 0;
  Eigen::Vector3d point;          // 1/m, d log g / d p_O
  Eigen::Vector3d log_semi_axes;  // d log g / d log a
  Eigen::Vector2d epsilon;        // d log g / d (e1, e2)
  Eigen::Vector2d taper;          // d log g / d (kx, ky)
};

/// The gauge at `p_O`; 0 in the centre.
double Gauge(const Superquadric& shape, const Eigen::Vector3d& p_O);

/// log g with all derivatives at `p_O`. At the centre, where the gradient does not exist, the
/// values are finite.
GaugeDerivatives DifferentiateGauge(const Superquadric& shape, const Eigen::Vector3d& p_O);

/// Unit outward normal, in O, of the scaled surface through `p_O`.
Eigen::Vector3d NormalAt(const Superquadric& shape, const Eigen::Vector3d& p_O);

/// Distance from `p_F` to the surface along the ray from the centre, m: |p| |1 - 1/g| (Whaite &
/// Ferrie 1991). Unsigned; for a tapered shape a first-order approximation.
double RadialDistance(const Superquadric& shape, const Eigen::Vector3d& p_F);

/// Mean of |RadialDistance| over points, m; 0 without points.
template <typename Points>
double MeanRadialDistance(const Superquadric& shape, const Points& points_F) {
  double sum = 0;
  for (const auto& p : points_F) sum += RadialDistance(shape, p.template cast<double>());
  return points_F.empty() ? 0 : sum / static_cast<double>(points_F.size());
}

/// The support function h(n) = max over the body of n·p, and its derivatives. The superquadric
/// without taper is a unit ball of nested p-norms, p = 2/e; its support function is the dual norm,
/// the same form with exponents 2 - e. Taper is ignored.
struct SupportDerivatives {
  double h = 0;                   // m
  Eigen::Vector3d point;          // the supporting point, = dh/dn, m
  Eigen::Vector3d log_semi_axes;  // dh / d log a
  Eigen::Vector2d epsilon;        // dh / d (e1, e2)
};
SupportDerivatives DifferentiateSupport(const Superquadric& shape,
                                        const Eigen::Vector3d& direction_O);

/// Half the width of the shape along a direction of F, m; for a tapered shape an upper bound.
double HalfWidth(const Superquadric& shape, const Eigen::Vector3d& direction_F);

}  // namespace beckon::pose
