// An object, or all of a scene: their superquadrics and how to grasp them.
#include "services/pose/estimate.h"

namespace beckon::pose {
namespace {

std::optional<Plane> TurnedToViewpoint(const FitInput& input) {
  if (!input.table_F || input.table_F->Distance(input.viewpoint_F) >= 0) return input.table_F;
  return Plane{-input.table_F->normal, -input.table_F->offset_m};
}

}  // namespace

FitResult FitObject(const FitInput& input, const FitConfig& config) {
  FitInput turned = input;
  turned.table_F = TurnedToViewpoint(input);
  return Fit(turned, config);
}

std::vector<GraspCandidate> GraspObject(const FitInput& input, const FitResult& fit,
                                        const Obstacles& obstacles, const GripperConfig& gripper) {
  const std::optional<Plane> table_F = TurnedToViewpoint(input);
  return table_F ? ProposeGrasps(fit, input.points_F, *table_F, obstacles, gripper)
                 : std::vector<GraspCandidate>{};
}

Estimate EstimateObject(const FitInput& input, const PoseConfig& config) {
  Estimate estimate;
  estimate.fit = FitObject(input, config.fit);
  estimate.grasps = GraspObject(input, estimate.fit, {}, config.gripper);
  return estimate;
}

std::vector<Estimate> EstimateScene(std::span<const FitInput> objects, const PoseConfig& config,
                                    const std::function<double()>& now_ms) {
  const auto now = [&] { return now_ms ? now_ms() : 0.0; };
  std::vector<Estimate> estimates;
  std::vector<Obstacle> obstacles;
  for (const FitInput& object : objects) {
    const double start_ms = now();
    Estimate& estimate = estimates.emplace_back();
    estimate.fit = FitObject(object, config.fit);
    estimate.time_ms = now() - start_ms;
    obstacles.push_back(MakeObstacle(object.points_F, estimate.fit, config.gripper.clearance_m));
  }
  for (size_t i = 0; i < objects.size(); ++i) {
    const double start_ms = now();
    estimates[i].grasps = GraspObject(objects[i], estimates[i].fit, {obstacles, i}, config.gripper);
    estimates[i].time_ms += now() - start_ms;
  }
  return estimates;
}

}  // namespace beckon::pose
