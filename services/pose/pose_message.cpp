// From an estimate in the camera's frame to a message in the table's.
#include "services/pose/pose_message.h"

namespace beckon::pose {
namespace {

// A product of poses drifts from orthogonality in the last digits; messages carry rotations.
Pose Orthonormal(Pose pose) {
  pose.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
  return pose;
}

}  // namespace

Plane TableInCamera(const Pose& X_WC) {
  // Height in W of a point in C: the third row of X_WC.
  return {X_WC.linear().row(2).transpose(), X_WC.translation().z()};
}

msg::ObjectPose ToMessage(const Estimate& estimate_C, const Pose& X_WC, int object_id,
                          double fit_ms) {
  const FitResult& fit = estimate_C.fit;
  msg::ObjectPose message;
  message.object_id = object_id;
  message.X_WO = Orthonormal(X_WC * fit.shape.X_FO);
  for (int i = 0; i < 3; ++i) message.semi_axes[i] = fit.shape.semi_axes[i];
  for (int i = 0; i < 2; ++i) {
    message.epsilon[i] = fit.shape.epsilon[i];
    message.taper[i] = fit.shape.taper[i];
  }
  message.mean_radial_distance_m = static_cast<float>(fit.mean_radial_distance_m);
  message.converged = fit.converged;
  message.ambiguous = fit.ambiguous;
  message.reason = fit.reason;
  Eigen::Matrix<double, 6, 6> turn = Eigen::Matrix<double, 6, 6>::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = X_WC.linear();
  message.covariance = (turn * fit.covariance * turn.transpose()).cast<float>();
  for (const GraspCandidate& grasp : estimate_C.grasps) {
    message.grasps.push_back(
        {Orthonormal(X_WC * grasp.X_FG), grasp.opening_m, static_cast<float>(grasp.score)});
  }
  message.fit_ms = static_cast<float>(fit_ms);
  return message;
}

}  // namespace beckon::pose
