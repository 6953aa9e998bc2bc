#include "services/base/geometry.h"

#include <cmath>

namespace beckon {

Status Validate(const Intrinsics& k) {
  for (double f : {k.fx, k.fy}) {
    if (!(f >= 10 && f <= 1e5))
      return Error{"focal length " + std::to_string(f) + " px: expected 10 .. 100000"};
  }
  for (double c : {k.cx, k.cy}) {
    if (!(std::abs(c) <= 1e5))
      return Error{"principal point " + std::to_string(c) + " px: expected a finite pixel"};
  }
  return {};
}

Result<Pose> MakePose(const std::array<double, 3>& position, const std::array<double, 4>& wxyz) {
  const Eigen::Vector3d t(position[0], position[1], position[2]);
  const Eigen::Quaterniond q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  if (!t.allFinite()) return Error{"pose: position is not finite"};
  if (!(std::abs(q.norm() - 1.0) < 1e-3)) return Error{"pose: quaternion is not of norm 1"};
  Pose pose = Pose::Identity();
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() = t;
  return pose;
}

std::array<double, 4> QuaternionWxyz(const Pose& pose) {
  Eigen::Quaterniond q(pose.linear());
  q.normalize();
  if (q.w() < 0) q.coeffs() *= -1;
  return {q.w(), q.x(), q.y(), q.z()};
}

Pose WorldFromTable(const Plane& table_C) {
  const Eigen::Vector3d z = table_C.normal.normalized();
  Eigen::Vector3d forward = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d y = forward - forward.dot(z) * z;
  if (y.norm() < 1e-3) {
    const Eigen::Vector3d image_up = -Eigen::Vector3d::UnitY();
    y = image_up - image_up.dot(z) * z;
  }
  y.normalize();
  Pose X_WC = Pose::Identity();
  X_WC.linear().row(0) = y.cross(z).transpose();
  X_WC.linear().row(1) = y.transpose();
  X_WC.linear().row(2) = z.transpose();
  X_WC.translation() = Eigen::Vector3d(0, 0, table_C.offset_m);
  return X_WC;
}

}  // namespace beckon
