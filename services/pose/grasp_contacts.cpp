// A superquadric between two fingers: where they touch it, how wide it is there, how steady it
// lies.
#include "services/pose/grasp_contacts.h"

#include <algorithm>
#include <cmath>

namespace beckon::pose {
namespace {

constexpr double kSteepest = 1.5;            // of the slanted planes that bound a slab
constexpr int kSlants = 6;                   // bisections of their slant
constexpr double kOnSurface = 1e-7;          // |log g| at a contact
constexpr int kMostSteps = 40;               // towards it
constexpr double kRoundTolerance = 0.04;     // of radii that count as equal
constexpr double kEllipsoidTolerance = 0.1;  // of exponents that count as 1

// Where the ray from a point inside leaves the shape: g is convex along it for shapes without
// taper, so that Newton's method converges from outside; a bracket keeps it safe for all.
double LeaveAt(const Superquadric& shape, const Eigen::Vector3d& from_O,
               const Eigen::Vector3d& ray_O, double outside) {
  double low = 0, high = outside;
  for (int i = 0; i < 8 && Gauge(shape, from_O + high * ray_O) < 1; ++i) high *= 2;
  double t = high;
  for (int i = 0; i < kMostSteps; ++i) {
    const GaugeDerivatives d = DifferentiateGauge(shape, from_O + t * ray_O);
    if (std::abs(d.log_g) < kOnSurface) break;
    (d.log_g < 0 ? low : high) = t;
    // g' = g (log g)'; the step of Newton's method for g = 1.
    const double step = (1 - std::exp(-d.log_g)) / d.point.dot(ray_O);
    t -= step;
    if (!(t > low && t < high)) t = 0.5 * (low + high);
  }
  return t;
}

}  // namespace

GraspedBody::GraspedBody(const Superquadric& shape) : shape_(shape), bound_(shape) {
  bound_.semi_axes.head<2>().array() *= 1 + shape.taper.array().abs();
  bound_.taper.setZero();
}

bool GraspedBody::Contains(const Eigen::Vector3d& p_F) const {
  return Gauge(shape_, shape_.X_FO.linear().transpose() * (p_F - centre_F())) < 1;
}

SupportDerivatives GraspedBody::Support(const Eigen::Vector3d& direction_F) const {
  return DifferentiateSupport(bound_, shape_.X_FO.linear().transpose() * direction_F);
}

double GraspedBody::HalfWidth(const Eigen::Vector3d& direction_F) const {
  return Support(direction_F).h;
}

double GraspedBody::ReachInSlab(const Eigen::Vector3d& along_F, const Eigen::Vector3d& across_F,
                                double offset_m, double half_width_m) const {
  const Eigen::Vector3d across_O = shape_.X_FO.linear().transpose() * across_F;
  const SupportDerivatives straight = Support(along_F);
  const double beyond_m = straight.point.dot(across_O) - offset_m;
  double least = straight.h;
  if (std::abs(beyond_m) <= half_width_m) return least;
  // The bound is convex in t; its derivative is the supporting point's place across the slab.
  const double sign = beyond_m > 0 ? -1 : 1;
  double low = 0, high = kSteepest;
  for (int i = 0; i < kSlants; ++i) {
    const double t = 0.5 * (low + high);
    const SupportDerivatives slanted = Support(along_F + sign * t * across_F);
    least = std::min(least, slanted.h - t * (sign * offset_m - half_width_m));
    const double slope = sign * (slanted.point.dot(across_O) - offset_m) + half_width_m;
    (slope < 0 ? low : high) = t;
  }
  return least;
}

std::optional<Contacts> FindContacts(const Superquadric& shape, const Eigen::Vector3d& inside_F,
                                     const Eigen::Vector3d& chord_F, double max_slip_rad) {
  const Eigen::Matrix3d R_OF = shape.X_FO.linear().transpose();
  const Eigen::Vector3d from = R_OF * (inside_F - shape.X_FO.translation());
  const Eigen::Vector3d chord = R_OF * chord_F;
  const double inside = Gauge(shape, from);
  if (!(inside < 1)) return std::nullopt;
  const double outside = (1 + inside) / Gauge(shape, chord);  // by the triangle inequality
  Contacts contacts;
  for (size_t i = 0; i < 2; ++i) {
    const Eigen::Vector3d ray = i == 0 ? chord : -chord;
    const double t = LeaveAt(shape, from, ray, outside);
    const Eigen::Vector3d at = from + t * ray;
    const double cosine = std::clamp(NormalAt(shape, at).dot(ray), -1.0, 1.0);
    contacts.slip_rad = std::max(contacts.slip_rad, std::acos(cosine));
    if (contacts.slip_rad > max_slip_rad) return std::nullopt;
    contacts.points_F[i] = shape.X_FO * at;
  }
  return contacts;
}

Eigen::Matrix3d IdleRotations(const Superquadric& shape) {
  Eigen::Matrix3d idle = Eigen::Matrix3d::Zero();
  const Eigen::Vector3d& a = shape.semi_axes;
  const auto equal = [&](double p, double q) {
    return std::abs(p - q) <= kRoundTolerance * std::max(p, q);
  };
  const bool ellipsoid =
      ((shape.epsilon.array() - 1).abs() < kEllipsoidTolerance).all() && shape.taper.isZero(0);
  for (int axis = 0; axis < 3; ++axis) {
    if (!ellipsoid && axis < 2) continue;
    if (!equal(a[(axis + 1) % 3], a[(axis + 2) % 3])) continue;
    if (std::abs(shape.epsilon[1] - 1) >= kEllipsoidTolerance) continue;
    if (axis == 2 && std::abs(shape.taper.x() - shape.taper.y()) > kRoundTolerance) continue;
    idle.col(axis) = shape.X_FO.linear().col(axis);
  }
  return idle;
}

}  // namespace beckon::pose
