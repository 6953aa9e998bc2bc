// How likely a grasp succeeds although the object's pose is known only so well.
#pragma once

#include "services/pose/grasp_contacts.h"

namespace beckon::pose {

/// The pose's uncertainty as fingers feel it.
class PoseSpread {
 public:
  /// `covariance`: as in FitResult. Rotations that change nothing (a can's about its axis, of which
  /// nobody knows anything) are left out.
  PoseSpread(const GraspedBody& body, const Eigen::Matrix<double, 6, 6>& covariance);

  /// Standard deviation of the object's place along a direction of F, m.
  double Along(const Eigen::Vector3d& direction_F) const;

  /// Standard deviation of where the object's surface is along a gripper's closing direction, m: of
  /// its place, and of the half width that it gains by turning about the gripper's other two axes,
  /// one standard deviation of each.
  double Closing(const Eigen::Matrix3d& R_FG) const;

  /// Standard deviation of the object's turn about an axis, rad, at most kWidestTurn_rad.
  double Turn(const Eigen::Vector3d& axis_F) const;

  static constexpr double kWidestTurn_rad = 0.8;  // about half of where a box repeats itself

 private:
  const GraspedBody& body_;
  Eigen::Matrix3d position_, rotation_;
};

/// P(-below < e < above), e being normal with mean 0.
double WithinProbability(double below, double above, double standard_deviation);

}  // namespace beckon::pose
