// Candidate grasps of a fitted superquadric for a parallel gripper.
#pragma once

#include <vector>

#include "services/base/geometry.h"
#include "services/pose/superquadric.h"

namespace beckon::pose {

struct GripperConfig {
  double max_opening_m = 0.10;        // between the fingers
  double finger_depth_m = 0.04;       // from the tips to the palm
  double finger_half_width_m = 0.01;  // of a finger, across closing and approach
  double clearance_m = 0.01;          // kept to the object on either side, and to the table
  double min_side_height_m = 0.08;    // objects at least this tall are also taken from the side
  double max_slip_rad =
      0.5;  // angle between closing direction and surface normal that friction holds
};

/// A pose of frame G: z = approach direction, x = closing direction, origin between the finger
/// tips.
struct GraspCandidate {
  Pose X_FG = Pose::Identity();
  double opening_m = 0;  // before closing
  double score = 0;      // 0..1: margin of the opening and closeness to the centroid, half each
};

/// Antipodal grasps, best first: from above closing across either horizontal principal axis, and,
/// for tall objects, from the four sides. None needs more than the gripper's opening, comes nearer
/// to the table than the clearance, or closes on surfaces that slip.
std::vector<GraspCandidate> ProposeGrasps(const Superquadric& shape, const Plane& table_F,
                                          const GripperConfig& gripper);

}  // namespace beckon::pose
