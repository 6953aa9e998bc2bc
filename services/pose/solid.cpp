// Moments of a superquadric in closed form (Jaklic, Leonardis & Solina 2000, section 2.4), extended
// to tapering: at the height s = z/a3 the section is that of the straight shape, its sides
// multiplied by 1 + kx s and 1 + ky s, so that integrals over the section gain a polynomial of s.
#include "services/pose/solid.h"

#include <array>
#include <cmath>

namespace beckon::pose {
namespace {

using Polynomial = std::array<double, 7>;  // coefficients of s^0 ..

double Beta(double x, double y) { return std::tgamma(x) * std::tgamma(y) / std::tgamma(x + y); }

// The integral of x^p y^q over |x|^(2/e) + |y|^(2/e) <= 1, p and q even (Dirichlet).
double SectionIntegral(double e, int p, int q) {
  return e * e * std::tgamma(0.5 * e * (p + 1)) * std::tgamma(0.5 * e * (q + 1)) /
         std::tgamma(0.5 * e * (p + q + 2) + 1);
}

// The integral of c(s) r(s)^m over -1 <= s <= 1, r = (1 - |s|^(2/e))^(e/2) being how the section
// shrinks towards the poles. Odd powers of s cancel.
double HeightIntegral(double e, int m, const Polynomial& c) {
  double sum = 0;
  for (size_t i = 0; i < c.size(); i += 2) {
    if (c[i] != 0) sum += c[i] * e * Beta(0.5 * e * static_cast<double>(i + 1), 0.5 * e * m + 1);
  }
  return sum;
}

Polynomial Times(const Polynomial& c, double k) {  // c(s) (1 + k s)
  Polynomial product = c;
  for (size_t i = 1; i < c.size(); ++i) product[i] += k * c[i - 1];
  return product;
}

Polynomial TimesS(const Polynomial& c, int power) {  // c(s) s^power
  Polynomial product{};
  for (size_t i = static_cast<size_t>(power); i < c.size(); ++i) {
    product[i] = c[i - static_cast<size_t>(power)];
  }
  return product;
}

}  // namespace

double Volume(const Superquadric& shape) { return ComputeSolidMoments(shape).volume_m3; }

SolidMoments ComputeSolidMoments(const Superquadric& shape) {
  const double e1 = shape.epsilon[0], e2 = shape.epsilon[1];
  const double kx = shape.taper.x(), ky = shape.taper.y();
  const Polynomial area = Times(Times({1}, kx), ky);
  const double section = SectionIntegral(e2, 0, 0);
  const double unit_volume = section * HeightIntegral(e1, 2, area);

  // Means over the solid, in units of the semi-axes.
  const double z = section * HeightIntegral(e1, 2, TimesS(area, 1)) / unit_volume;
  const double zz = section * HeightIntegral(e1, 2, TimesS(area, 2)) / unit_volume;
  const double across = SectionIntegral(e2, 2, 0) / unit_volume;
  const double xx = across * HeightIntegral(e1, 4, Times(Times(area, kx), kx));
  const double yy = across * HeightIntegral(e1, 4, Times(Times(area, ky), ky));

  SolidMoments solid;
  solid.volume_m3 = shape.semi_axes.prod() * unit_volume;
  solid.centroid_F = shape.X_FO * Eigen::Vector3d(0, 0, shape.semi_axes.z() * z);
  const Eigen::Vector3d variance =
      shape.semi_axes.cwiseAbs2().cwiseProduct(Eigen::Vector3d(xx, yy, zz - z * z));
  const Eigen::Matrix3d& R = shape.X_FO.linear();
  solid.covariance_F = R * variance.asDiagonal() * R.transpose();
  return solid;
}

Eigen::Matrix3d Inertia(const SolidMoments& solid, double mass_kg) {
  const Eigen::Matrix3d& S = solid.covariance_F;
  return mass_kg * (S.trace() * Eigen::Matrix3d::Identity() - S);
}

}  // namespace beckon::pose
