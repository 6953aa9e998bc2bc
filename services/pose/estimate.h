// An object, or all of a scene: their superquadrics and how to grasp them.
#pragma once

#include <functional>
#include <span>
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
  double time_ms = 0;                  // of fit and grasps, where a clock was given
};

/// Fits an object, in the input's frame. The table's normal may point either way; it is turned to
/// the viewpoint.
FitResult FitObject(const FitInput& input, const FitConfig& config);

/// Grasps of the object that `fit` is of, among obstacles.
std::vector<GraspCandidate> GraspObject(const FitInput& input, const FitResult& fit,
                                        const Obstacles& obstacles, const GripperConfig& gripper);

/// Fits an object that stands alone, and proposes grasps.
Estimate EstimateObject(const FitInput& input, const PoseConfig& config);

/// The same of objects that stand together: the grasps of each stay clear of all others. `now_ms`,
/// where given, is a clock that tells each object's time.
std::vector<Estimate> EstimateScene(std::span<const FitInput> objects, const PoseConfig& config,
                                    const std::function<double()>& now_ms = {});

}  // namespace beckon::pose
