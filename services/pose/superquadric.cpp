// Superquadric functions in log space, so that exponents of 2/0.05 neither overflow nor underflow.
#include "services/pose/superquadric.h"

#include <algorithm>
#include <cmath>

namespace beckon::pose {
namespace {

constexpr double kTiny = 1e-12;           // relative size below which a coordinate counts as zero
constexpr double kMinTaperFactor = 1e-3;  // beyond a taper's apex the shape is continued by this

// log((exp(2u/e) + exp(2v/e))^(e/2)) with the weight of u and the derivative by e, which is half
// the entropy of the two weights.
struct LogNorm2 {
  double value, weight, by_e;
};
LogNorm2 LogNorm(double u, double v, double e) {
  const double t = 2 * (u - v) / e;
  const double ratio = std::exp(-std::abs(t));  // smaller term over the larger
  const double log1p = std::log(1 + ratio);
  const double larger = 1 / (1 + ratio), smaller = ratio * larger;
  // Entropy: -larger log(larger) - smaller log(smaller).
  const double entropy = log1p + smaller * std::abs(t);
  return {std::max(u, v) + 0.5 * e * log1p, t >= 0 ? larger : smaller, 0.5 * entropy};
}

// The nested norm of three log-lengths: gauge and support function are both of this form.
struct LogNorm3 {
  double value;
  Eigen::Vector3d weight;  // derivative by each log-length; sums to 1
  Eigen::Vector2d by_e;
};
LogNorm3 NestedLogNorm(const Eigen::Vector3d& l, const Eigen::Vector2d& e) {
  const LogNorm2 xy = LogNorm(l.x(), l.y(), e[1]);
  const LogNorm2 xyz = LogNorm(xy.value, l.z(), e[0]);
  return {xyz.value,
          {xyz.weight * xy.weight, xyz.weight * (1 - xy.weight), 1 - xyz.weight},
          {xyz.by_e, xyz.weight * xy.by_e}};
}

// |value| with the size of a coordinate that is zero.
double NotZero(double value, double scale) { return std::max(std::abs(value), kTiny * scale); }

}  // namespace

double Gauge(const Superquadric& shape, const Eigen::Vector3d& p_O) {
  if (p_O.isZero(0)) return 0;
  return std::exp(DifferentiateGauge(shape, p_O).log_g);
}

GaugeDerivatives DifferentiateGauge(const Superquadric& shape, const Eigen::Vector3d& p_O) {
  const Eigen::Vector3d& a = shape.semi_axes;
  const Eigen::Vector3d size(NotZero(p_O.x(), a.x()), NotZero(p_O.y(), a.y()),
                             NotZero(p_O.z(), a.z()));
  const Eigen::Vector3d by_a = a.cwiseInverse();
  Eigen::Vector3d l = size.cwiseProduct(by_a).array().log();
  const double height = p_O.z() * by_a.z();
  Eigen::Vector2d by_factor(1, 1);  // 1 over what the taper multiplies x and y by
  if (!shape.taper.isZero(0)) {
    const Eigen::Vector2d factor = (shape.taper * height).array() + 1.0;
    l.head<2>() -= factor.cwiseMax(kMinTaperFactor).array().log().matrix();
    for (int i = 0; i < 2; ++i) by_factor[i] = factor[i] > kMinTaperFactor ? 1 / factor[i] : 0;
  }

  const LogNorm3 norm = NestedLogNorm(l, shape.epsilon);
  GaugeDerivatives d;
  d.log_g = norm.value;
  d.log_semi_axes = -norm.weight;
  d.epsilon = norm.by_e;
  for (int i = 0; i < 3; ++i) d.point[i] = std::copysign(norm.weight[i] / size[i], p_O[i]);
  d.taper = -height * norm.weight.head<2>().cwiseProduct(by_factor);
  const double by_height = -norm.weight.head<2>().cwiseProduct(by_factor).dot(shape.taper);
  d.point.z() += by_height * by_a.z();
  d.log_semi_axes.z() -= by_height * height;
  return d;
}

Eigen::Vector3d NormalAt(const Superquadric& shape, const Eigen::Vector3d& p_O) {
  return DifferentiateGauge(shape, p_O).point.stableNormalized();
}

double RadialDistance(const Superquadric& shape, const Eigen::Vector3d& p_F) {
  const Eigen::Vector3d p_O = shape.X_FO.inverse() * p_F;
  const double g = std::max(Gauge(shape, p_O), kTiny);
  return p_O.norm() < kTiny ? shape.semi_axes.minCoeff() : p_O.norm() * std::abs(1 - 1 / g);
}

SupportDerivatives DifferentiateSupport(const Superquadric& shape,
                                        const Eigen::Vector3d& direction_O) {
  const Eigen::Vector3d size = direction_O.cwiseAbs().cwiseMax(kTiny);
  const Eigen::Vector3d l = (size.array() * shape.semi_axes.array()).log();
  const Eigen::Vector2d dual = (2 - shape.epsilon.array()).max(kMinEpsilon);
  const LogNorm3 norm = NestedLogNorm(l, dual);
  SupportDerivatives d;
  d.h = std::exp(norm.value);
  d.log_semi_axes = d.h * norm.weight;
  d.epsilon = -d.h * norm.by_e;
  for (int i = 0; i < 3; ++i) {
    d.point[i] = std::copysign(d.h * norm.weight[i] / size[i], direction_O[i]);
  }
  return d;
}

double HalfWidth(const Superquadric& shape, const Eigen::Vector3d& direction_F) {
  Superquadric bound = shape;
  bound.semi_axes.head<2>().array() *= 1 + shape.taper.array().abs();
  return DifferentiateSupport(bound, shape.X_FO.linear().transpose() * direction_F).h;
}

}  // namespace beckon::pose
