// One object: its superquadric and how to grasp it.
#pragma once

#include <vector>

#include "services/pose/fit.h"
#include "services/pose/grasps.h"

namespace beckon::pose {

struct PoseConfig {
  FitConfig fit;
  GripperConfig gripper;
};

struct Estimate {
  FitResult fit;
  std::vector<GraspCandidate> grasps;  // none without a table or a converged fit
};

/// Fits and proposes grasps, all in the input's frame. The table's normal may point either way; it
/// is turned to the viewpoint.
Estimate EstimateObject(FitInput input, const PoseConfig& config);

}  // namespace beckon::pose
