// Volume and points of a superquadric's surface.
#include "services/pose/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace beckon::pose {
namespace {

double Beta(double x, double y) {
  return std::exp(std::lgamma(x) + std::lgamma(y) - std::lgamma(x + y));
}

Eigen::Vector3d ToFrame(const Superquadric& shape, Eigen::Vector3d straight_O) {
  const double s = straight_O.z() / shape.semi_axes.z();
  straight_O.x() *= shape.taper.x() * s + 1;
  straight_O.y() *= shape.taper.y() * s + 1;
  return shape.X_FO * straight_O;
}

// Where a ray from the centre cuts the straight surface: at 1/g of its length.
Eigen::Vector3d CutRay(const Superquadric& shape, const Eigen::Vector3d& ray) {
  Superquadric straight = shape;
  straight.taper.setZero();
  return ray / Gauge(straight, ray);
}

}  // namespace

double Volume(const Superquadric& shape) {
  const auto [e1, e2] = std::array{shape.epsilon[0], shape.epsilon[1]};
  const double straight =
      2 * shape.semi_axes.prod() * e1 * e2 * Beta(e1 / 2 + 1, e1) * Beta(e2 / 2, e2 / 2);
  // Tapering multiplies the cross-section at height s = z/a3 by (1 + kx s)(1 + ky s); odd powers of
  // s cancel, and the mean of s^2 over the shape is B(3 e1/2, e1 + 1) / B(e1/2, e1 + 1).
  const double mean_s2 = Beta(1.5 * e1, e1 + 1) / Beta(0.5 * e1, e1 + 1);
  return straight * (1 + shape.taper.x() * shape.taper.y() * mean_s2);
}

std::vector<Eigen::Vector3d> SampleSurface(const Superquadric& shape, int count) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(static_cast<size_t>(std::max(count, 0)));
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  // Rays of a sphere crowd the middle of long shapes; stretching by the square root of the
  // semi-axes balances the middle against the ends.
  const Eigen::Vector3d stretch = shape.semi_axes.array().sqrt();
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count;
    const double r = std::sqrt(1 - z * z);
    const Eigen::Vector3d ray(r * std::cos(golden * i), r * std::sin(golden * i), z);
    points.push_back(ToFrame(shape, CutRay(shape, ray.cwiseProduct(stretch))));
  }
  return points;
}

Eigen::Vector3d SurfacePoint(const Superquadric& shape, double latitude, double longitude) {
  const Eigen::Vector3d ray(std::cos(latitude) * std::cos(longitude),
                            std::cos(latitude) * std::sin(longitude), std::sin(latitude));
  return ToFrame(shape, CutRay(shape, ray.cwiseProduct(shape.semi_axes)));
}

double ShapeDifference(const Superquadric& a, const Superquadric& b) {
  constexpr int kSamples = 64;
  return 0.5 * (MeanRadialDistance(a, SampleSurface(b, kSamples)) +
                MeanRadialDistance(b, SampleSurface(a, kSamples)));
}

}  // namespace beckon::pose
