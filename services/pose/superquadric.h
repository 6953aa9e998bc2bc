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

/// log g and its derivatives at a point, g being the gauge: F = g^(2/e1), g = 1 on the surface.
/// Without taper g(s p) = s g(p), and g is a norm. Exact to rounding for coordinates of 1e-9 to
/// 1e6 semi-axes; F itself, which overflows, is not offered (Solina & Bajcsy's F^e1 is g^2).
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
/// values are finite; across a plane of symmetry the derivative is 0, also at the ridges of e = 2.
GaugeDerivatives DifferentiateGauge(const Superquadric& shape, const Eigen::Vector3d& p_O);

/// Unit outward normal, in O, of the surface g = constant through `p_O` (the gradient's direction;
/// Barr 1981 gives it by the dual superquadric).
Eigen::Vector3d NormalAt(const Superquadric& shape, const Eigen::Vector3d& p_O);

/// The factor by which `p_O` is to be multiplied to lie on the surface: 1/g, for a tapered shape
/// found by Newton's method, to 1e-12. Every ray from the centre leaves the shape once. Not for the
/// centre.
double StretchToSurface(const Superquadric& shape, const Eigen::Vector3d& p_O);

/// Distance from `p_F` to the surface along the ray from the centre, m, unsigned: |p| |1 - 1/g|
/// (Whaite & Ferrie 1991), for tapered shapes too. At the centre the smallest semi-axis.
double RadialDistance(const Superquadric& shape, const Eigen::Vector3d& p_F);

/// Mean of |RadialDistance| over points, m; 0 without points.
template <typename Points>
double MeanRadialDistance(const Superquadric& shape, const Points& points_F) {
  double sum = 0;
  for (const auto& p : points_F) sum += RadialDistance(shape, p.template cast<double>());
  return points_F.empty() ? 0 : sum / static_cast<double>(points_F.size());
}

/// The support function h(n) = max over the body of n·p, and its derivatives. The superquadric
/// without taper is the unit ball of nested p-norms, p = 2/e; its support function is the dual norm
/// (Rockafellar 1970, section 15), the same form with exponents 2 - e, as 1/p + 1/q = 1. Taper is
/// ignored: with it there is no closed form.
struct SupportDerivatives {
  double h = 0;                   // m
  Eigen::Vector3d point;          // the supporting point, = dh/dn, m; of a face its middle
  Eigen::Vector3d log_semi_axes;  // dh / d log a
  Eigen::Vector2d epsilon;        // dh / d (e1, e2)
};
SupportDerivatives DifferentiateSupport(const Superquadric& shape,
                                        const Eigen::Vector3d& direction_O);

/// Half the width of the shape along a direction of F, m. For a tapered shape an upper bound: that
/// of the straight shape which is everywhere as wide as the wide end.
double HalfWidth(const Superquadric& shape, const Eigen::Vector3d& direction_F);

}  // namespace beckon::pose
