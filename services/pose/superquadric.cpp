// Superquadric functions in log space, so that exponents of 2/0.05 neither overflow nor underflow.
#include "services/pose/superquadric.h"

#include <algorithm>
#include <cmath>

namespace beckon::pose {
namespace {

constexpr double kTiny = 1e-12;           // relative size below which a coordinate counts as zero
constexpr double kTinySlope = 1e-200;     // what stands for a direction's zero where logs are taken
constexpr double kMinDual = 1e-9;         // stands for the dual exponent of e = 2, the maximum norm
constexpr double kMinTaperFactor = 1e-3;  // beyond a taper's apex the shape is continued by this

// log((exp(2u/e) + exp(2v/e))^(e/2)) with its derivatives: by u and v the weights, of which neither
// is found as 1 less the other (a small one would lose its digits), by e half their entropy.
struct LogNorm2 {
  double value, by_u, by_v, by_e;
};
LogNorm2 LogNorm(double u, double v, double e) {
  const double t = 2 * (u - v) / e;
  const double ratio = std::exp(-std::abs(t));  // smaller term over the larger
  const double log1p = std::log(1 + ratio);
  const double larger = 1 / (1 + ratio), smaller = ratio * larger;
  // Entropy: -larger log(larger) - smaller log(smaller).
  const double entropy = log1p + smaller * std::abs(t);
  return {std::max(u, v) + 0.5 * e * log1p, t >= 0 ? larger : smaller, t >= 0 ? smaller : larger,
          0.5 * entropy};
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
          {xyz.by_u * xy.by_u, xyz.by_u * xy.by_v, xyz.by_v},
          {xyz.by_e, xyz.by_u * xy.by_e}};
}

// |value| with the size of a coordinate that is zero.
double NotZero(double value, double scale) { return std::max(std::abs(value), kTiny * scale); }

// The straight shape that is everywhere as wide as the taper's wide end.
Superquadric Enclosing(const Superquadric& shape) {
  Superquadric enclosing = shape;
  enclosing.semi_axes.head<2>().array() *= 1 + shape.taper.array().abs();
  enclosing.taper.setZero();
  return enclosing;
}

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
  // By symmetry nothing changes across a plane of symmetry; at the centre itself the slope stays.
  const bool centre = p_O.isZero(0);
  for (int i = 0; i < 3; ++i) {
    d.point[i] = p_O[i] != 0 || centre ? std::copysign(norm.weight[i] / size[i], p_O[i]) : 0.0;
  }
  d.taper = -height * norm.weight.head<2>().cwiseProduct(by_factor);
  const double by_height = -norm.weight.head<2>().cwiseProduct(by_factor).dot(shape.taper);
  d.point.z() += by_height * by_a.z();
  d.log_semi_axes.z() -= by_height * height;
  return d;
}

Eigen::Vector3d NormalAt(const Superquadric& shape, const Eigen::Vector3d& p_O) {
  return DifferentiateGauge(shape, p_O).point.stableNormalized();
}

double StretchToSurface(const Superquadric& shape, const Eigen::Vector3d& p_O) {
  if (shape.taper.isZero(0)) return 1 / std::max(Gauge(shape, p_O), kTiny);
  // Newton's method for log g = 0 over the log of the factor, in which log g grows strictly,
  // tapered or not. The surface lies within the straight shape that is as wide as the taper's wide
  // end, and as far out as a narrow end of kMinTaperFactor is.
  double most = -std::log(std::max(Gauge(Enclosing(shape), p_O), kTiny));
  double least = most + std::log(0.5 * kMinTaperFactor) - 0.1;
  double log_factor = most;
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector3d p = std::exp(log_factor) * p_O;
    const GaugeDerivatives d = DifferentiateGauge(shape, p);
    if (std::abs(d.log_g) < 1e-13) break;
    (d.log_g > 0 ? most : least) = log_factor;
    const double newton = log_factor - d.log_g / d.point.dot(p);
    log_factor = newton > least && newton < most ? newton : 0.5 * (least + most);
  }
  return std::exp(log_factor);
}

double RadialDistance(const Superquadric& shape, const Eigen::Vector3d& p_F) {
  const Eigen::Vector3d p_O = shape.X_FO.inverse() * p_F;
  if (p_O.norm() < kTiny) return shape.semi_axes.minCoeff();
  return p_O.norm() * std::abs(1 - StretchToSurface(shape, p_O));
}

SupportDerivatives DifferentiateSupport(const Superquadric& shape,
                                        const Eigen::Vector3d& direction_O) {
  const Eigen::Vector3d size = direction_O.cwiseAbs().cwiseMax(kTinySlope);
  const Eigen::Vector3d l = (size.array() * shape.semi_axes.array()).log();
  const Eigen::Vector2d dual = (2 - shape.epsilon.array()).max(kMinDual);
  const LogNorm3 norm = NestedLogNorm(l, dual);
  SupportDerivatives d;
  d.h = std::exp(norm.value);
  d.log_semi_axes = d.h * norm.weight;
  d.epsilon = -d.h * norm.by_e;
  for (int i = 0; i < 3; ++i) {
    d.point[i] =
        direction_O[i] != 0 ? std::copysign(d.h * norm.weight[i] / size[i], direction_O[i]) : 0.0;
  }
  return d;
}

double HalfWidth(const Superquadric& shape, const Eigen::Vector3d& direction_F) {
  return DifferentiateSupport(Enclosing(shape), shape.X_FO.linear().transpose() * direction_F).h;
}

}  // namespace beckon::pose
