// Grasps of an open vessel by its rim, which a convex shape knows nothing of: from the points.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "services/base/geometry.h"
#include "services/pose/grasp_gripper.h"

namespace beckon::pose {

/// A pinch of the wall from straight above, closing outwards.
struct RimPinch {
  Pose X_FG = Pose::Identity();  // origin between the tips, level with the middle of the wall
  double width_m = 0;            // of the wall as far as it is between the fingers
  double slip_rad = 0;           // between closing direction and the wall's normal
  double held_m = 0;             // of the wall between the fingers, along them
};

/// What the points show of a vessel's opening.
struct OpenRim {
  double seen = 0;  // 0..1, of the directions all around, those in which the rim was seen
  Eigen::Vector3d middle_F = Eigen::Vector3d::Zero();  // of the rim
  std::vector<RimPinch> pinches;                       // where the rim was seen and can be pinched
};

/// Looks for an opening: points clearly below the highest ones inside their outline, and none at
/// their height there. No pinches where there is none, or too little of the rim was seen. A wall's
/// hidden face is taken to be kWall_m (in the .cpp) from the one that is seen.
OpenRim FindOpenRim(std::span<const Eigen::Vector3f> points_F, const Plane& table_F,
                    const GripperConfig& gripper);

}  // namespace beckon::pose
