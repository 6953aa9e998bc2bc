// A parallel gripper: its measures, and the room it takes while it approaches and closes.
#pragma once

#include <array>

#include "services/base/geometry.h"

namespace beckon::pose {

/// Lengths are those of the open gripper. Frame G: z = approach direction, x = closing direction,
/// origin between the finger tips.
struct GripperConfig {
  double max_opening_m = 0.10;        // between the fingers
  double finger_depth_m = 0.04;       // from the tips to the palm, along z
  double finger_half_width_m = 0.01;  // of a finger, along y
  double finger_thickness_m = 0.01;   // of a finger, along x
  double palm_width_m = 0.12;         // along x
  double palm_thickness_m = 0.06;     // along y
  double palm_depth_m = 0.06;         // along z, to the wrist
  double approach_m = 0.10;           // straight way along z to the grasp
  double clearance_m = 0.01;  // kept to the object on either side, to the table and to neighbours
  double max_slip_rad = 0.5;  // between closing direction and surface normal that friction holds
};

/// A box in G, symmetric in x and y.
struct HandBox {
  double half_x_m, half_y_m, z_min_m, z_max_m;
};

/// What the gripper sweeps on its straight approach with the fingers `opening_m` apart, the grasp
/// included: the fingers with all between them, and the palm.
std::array<HandBox, 2> SweptVolume(const GripperConfig& gripper, double opening_m);

/// Height of the lowest point of `hand` over a plane, m; negative below it.
double LowestPoint(const std::array<HandBox, 2>& hand, const Pose& X_FG, const Plane& plane_F);

}  // namespace beckon::pose
