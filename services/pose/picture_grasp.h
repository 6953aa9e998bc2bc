// A grasp in a picture: a gripper of two fingers and a palm, and the way it comes.
#pragma once

#include <vector>

#include "services/pose/grasps.h"
#include "services/pose/picture_canvas.h"
#include "services/pose/picture_view.h"

namespace beckon::pose {

/// The gripper, open as it comes: what `shape` hides of it in outline, the rest translucent, with
/// an arrow of approach.
void DrawGrasp(const GraspCandidate& grasp, const GripperConfig& gripper, const Superquadric& shape,
               const PictureView& view, Canvas* canvas);

/// What a picture must have room for.
std::vector<Eigen::Vector3d> Extremes(const GraspCandidate& grasp, const GripperConfig& gripper);

}  // namespace beckon::pose
