// From an estimate in the camera's frame to a message in the table's.
#include "services/pose/pose_message.h"

#include <algorithm>
#include <cstdint>

namespace beckon::pose {
namespace {

// A product of poses drifts from orthogonality in the last digits; messages carry rotations.
Pose Orthonormal(Pose pose) {
  pose.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
  return pose;
}

msg::SuperquadricShape ToMessage(const Superquadric& shape_C, const Pose& X_WC) {
  msg::SuperquadricShape message;
  message.X_WO = Orthonormal(X_WC * shape_C.X_FO);
  for (int i = 0; i < 3; ++i) message.semi_axes[i] = shape_C.semi_axes[i];
  for (int i = 0; i < 2; ++i) {
    message.epsilon[i] = shape_C.epsilon[i];
    message.taper[i] = shape_C.taper[i];
  }
  return message;
}

/// Of all of `shapes`, or of the first `most`.
std::vector<msg::SuperquadricShape> ToMessages(const std::vector<Superquadric>& shapes_C,
                                               const Pose& X_WC, size_t most = SIZE_MAX) {
  std::vector<msg::SuperquadricShape> messages;
  for (size_t i = 0; i < std::min(shapes_C.size(), most); ++i) {
    messages.push_back(ToMessage(shapes_C[i], X_WC));
  }
  return messages;
}

// Of an encoded object pose, in bytes; lcmtypes/object_pose_t.lcm. A little more than they are.
constexpr size_t kBytesOfMessage = 240, kBytesOfPose = 320, kBytesOfShape = 112, kBytesOfGrasp = 68;
constexpr size_t kLongestReason = 400;
constexpr size_t kGraspsWorthKeeping = 4;

size_t Bytes(const msg::Poses& poses) {
  size_t bytes = kBytesOfMessage;
  for (const auto& pose : poses.poses) {
    bytes += kBytesOfPose + pose.reason.size() + kBytesOfGrasp * pose.grasps.size() +
             kBytesOfShape * (pose.alternatives.size() + pose.parts.size());
  }
  return bytes;
}

/// Shortens the longest of all lists until the message fits, but none to fewer than `fewest`.
template <typename T>
void Shorten(msg::Poses& poses, std::vector<T> msg::ObjectPose::*list, size_t fewest) {
  size_t longest = 0;
  for (const auto& pose : poses.poses) longest = std::max(longest, (pose.*list).size());
  for (; longest > fewest && Bytes(poses) > msg::kMaxDatagram; --longest) {
    for (auto& pose : poses.poses) {
      if ((pose.*list).size() >= longest) (pose.*list).resize(longest - 1);
    }
  }
}

}  // namespace

Plane TableInCamera(const Pose& X_WC) {
  // Height in W of a point in C: the third row of X_WC.
  return {X_WC.linear().row(2).transpose(), X_WC.translation().z()};
}

msg::ObjectPose ToMessage(const Estimate& estimate_C, const Pose& X_WC, int object_id,
                          double fit_ms) {
  const FitResult& fit = estimate_C.fit;
  const msg::SuperquadricShape shape = ToMessage(fit.shape, X_WC);
  msg::ObjectPose message;
  message.object_id = object_id;
  message.X_WO = shape.X_WO;
  message.semi_axes = shape.semi_axes;
  message.epsilon = shape.epsilon;
  message.taper = shape.taper;
  message.mean_radial_distance_m = static_cast<float>(fit.mean_radial_distance_m);
  message.converged = fit.converged;
  message.ambiguous = fit.ambiguous;
  message.reason = fit.reason;
  Eigen::Matrix<double, 6, 6> turn = Eigen::Matrix<double, 6, 6>::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = X_WC.linear();
  message.covariance = (turn * fit.covariance * turn.transpose()).cast<float>();
  message.alternatives = ToMessages(fit.alternatives, X_WC, msg::kMaxAlternatives);
  // Some of the parts would not be the object.
  if (fit.parts.size() > 1 && fit.parts.size() <= msg::kMaxParts)
    message.parts = ToMessages(fit.parts, X_WC);
  for (const GraspCandidate& grasp : estimate_C.grasps) {
    if (message.grasps.size() == msg::kMaxGrasps) break;
    message.grasps.push_back(
        {Orthonormal(X_WC * grasp.X_FG), grasp.opening_m, static_cast<float>(grasp.score)});
  }
  message.fit_ms = static_cast<float>(fit_ms);
  return message;
}

void FitDatagram(msg::Poses& poses) {
  for (auto& pose : poses.poses) {
    if (pose.reason.size() > kLongestReason) pose.reason.resize(kLongestReason);
  }
  Shorten(poses, &msg::ObjectPose::grasps, kGraspsWorthKeeping);
  Shorten(poses, &msg::ObjectPose::alternatives, 0);
  for (size_t i = poses.poses.size(); i-- > 0 && Bytes(poses) > msg::kMaxDatagram;) {
    poses.poses[i].parts.clear();
  }
  Shorten(poses, &msg::ObjectPose::grasps, 0);
}

}  // namespace beckon::pose
