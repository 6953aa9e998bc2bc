// One object: its superquadric and how to grasp it.
#include "services/pose/estimate.h"

namespace beckon::pose {

Estimate EstimateObject(FitInput input, const PoseConfig& config) {
  if (input.table_F && input.table_F->Distance(input.viewpoint_F) < 0) {
    input.table_F = Plane{-input.table_F->normal, -input.table_F->offset_m};
  }
  Estimate estimate;
  estimate.fit = Fit(input, config.fit);
  if (estimate.fit.converged && input.table_F) {
    estimate.grasps = ProposeGrasps(estimate.fit.shape, *input.table_F, config.gripper);
  }
  return estimate;
}

}  // namespace beckon::pose
