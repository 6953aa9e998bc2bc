// A superquadric between two fingers: where they touch it, how wide it is there, how steady it
// lies.
#pragma once

#include <array>
#include <optional>

#include "services/pose/superquadric.h"

namespace beckon::pose {

/// What is asked of a shape in a frame F while grasps of it are sought.
class GraspedBody {
 public:
  explicit GraspedBody(const Superquadric& shape);

  const Superquadric& shape() const { return shape_; }
  Eigen::Vector3d centre_F() const { return shape_.X_FO.translation(); }

  bool Contains(const Eigen::Vector3d& p_F) const;

  /// Half the width along a direction, m; an upper bound where the shape is tapered.
  double HalfWidth(const Eigen::Vector3d& direction_F) const;

  /// Farthest reach from the centre along `along_F` of that part of the shape whose points q have
  /// |(q - centre)·across_F - offset_m| <= half_width_m, m; an upper bound. Weak duality: it is at
  /// most h(along + t across) - t offset + |t| half_width for every t, h being the support function
  /// (Boyd & Vandenberghe, Convex Optimization, 5.1.3); the smallest of these is sought.
  double ReachInSlab(const Eigen::Vector3d& along_F, const Eigen::Vector3d& across_F,
                     double offset_m, double half_width_m) const;

 private:
  SupportDerivatives Support(const Eigen::Vector3d& direction_F) const;

  Superquadric shape_;
  Superquadric bound_;  // without taper, around the shape
};

/// Both ends of a chord of the shape.
struct Contacts {
  std::array<Eigen::Vector3d, 2> points_F;  // in direction of the chord, and against it
  double slip_rad = 0;  // larger angle between chord and surface normal at its ends
};

/// The chord through `inside_F` along `chord_F`; none where the point is not inside, or a surface
/// normal is more than `max_slip_rad` off the chord. Two contacts hold an object by friction where
/// the chord is within both friction cones (Nguyen 1988).
std::optional<Contacts> FindContacts(const Superquadric& shape, const Eigen::Vector3d& inside_F,
                                     const Eigen::Vector3d& chord_F, double max_slip_rad);

/// Rotations (of O, orthonormal columns, the others zero) that change nothing to speak of: all of a
/// ball's, one of a can's or an egg's, none of a box's.
Eigen::Matrix3d IdleRotations(const Superquadric& shape);

}  // namespace beckon::pose
