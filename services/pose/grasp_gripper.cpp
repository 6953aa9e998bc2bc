// A parallel gripper: its measures, and the room it takes while it approaches and closes.
#include "services/pose/grasp_gripper.h"

#include <algorithm>
#include <cmath>

namespace beckon::pose {

std::array<HandBox, 2> SweptVolume(const GripperConfig& g, double opening_m) {
  const double back_m = g.finger_depth_m + g.approach_m;
  return {HandBox{0.5 * opening_m + g.finger_thickness_m, g.finger_half_width_m, -back_m, 0},
          HandBox{0.5 * g.palm_width_m, 0.5 * g.palm_thickness_m, -back_m - g.palm_depth_m,
                  -g.finger_depth_m}};
}

double LowestPoint(const std::array<HandBox, 2>& hand, const Pose& X_FG, const Plane& plane_F) {
  const Eigen::Vector3d up_G = X_FG.linear().transpose() * plane_F.normal;
  double lowest = 0;  // relative to the tips
  for (const HandBox& box : hand) {
    lowest =
        std::min(lowest, std::min(box.z_min_m * up_G.z(), box.z_max_m * up_G.z()) -
                             box.half_x_m * std::abs(up_G.x()) - box.half_y_m * std::abs(up_G.y()));
  }
  return plane_F.Distance(X_FG.translation()) + lowest;
}

}  // namespace beckon::pose
