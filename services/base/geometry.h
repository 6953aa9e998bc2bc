// Poses, planes and the pinhole camera. Monogram notation: X_WO is the pose of frame O in frame W,
// p_WQ the point Q in W; p_WQ = X_WO * p_OQ.
//
// Frames: W world (table-aligned, z up), C camera optical (x right, y down, z forward), O object,
// G gripper.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "services/base/result.h"

namespace beckon {

using Pose = Eigen::Isometry3d;

/// The plane n·p + d = 0, |n| = 1.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset_m = 0;

  /// Signed distance, positive on the side the normal points to.
  double Distance(const Eigen::Vector3d& p) const { return normal.dot(p) + offset_m; }
};

/// Pinhole camera; pixel centres at integer coordinates, no distortion.
struct Intrinsics {
  double fx = 525.0;  // px
  double fy = 525.0;
  double cx = 319.5;
  double cy = 239.5;

  Eigen::Vector3d Unproject(double u, double v, double depth_m) const {
    return {(u - cx) / fx * depth_m, (v - cy) / fy * depth_m, depth_m};
  }
  /// `p_C` in front of the camera.
  Eigen::Vector2d Project(const Eigen::Vector3d& p_C) const {
    return {fx * p_C.x() / p_C.z() + cx, fy * p_C.y() / p_C.z() + cy};
  }
};

/// Refuses intrinsics that no camera has: non-finite, focal lengths outside 10..100000 px.
Status Validate(const Intrinsics& intrinsics);

/// From a position and a quaternion w x y z, as messages and files carry it; refuses non-finite
/// values and a quaternion whose norm is off 1 by more than 1e-3.
Result<Pose> MakePose(const std::array<double, 3>& position, const std::array<double, 4>& wxyz);

/// The unit quaternion w x y z of a pose, with w >= 0.
std::array<double, 4> QuaternionWxyz(const Pose& pose);

/// The camera's pose in the world frame that a table defines: z = the table's normal, origin = foot
/// of the camera's perpendicular on the table, y = the viewing direction along the table, x =
/// right. `table_C`: normal pointing to the camera. A camera looking straight down takes its
/// image's up as y.
Pose WorldFromTable(const Plane& table_C);

}  // namespace beckon
