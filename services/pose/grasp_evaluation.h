// Whether a gripper can do what a grasp's idea wants of it, and how well.
#pragma once

#include <optional>
#include <span>

#include "services/pose/grasp_directions.h"
#include "services/pose/grasp_rim.h"
#include "services/pose/grasp_uncertainty.h"
#include "services/pose/grasps.h"

namespace beckon::pose {

/// A grasp whose score is not yet lowered by obstacles and by other shapes that the object may
/// have.
struct RatedGrasp {
  GraspCandidate grasp;
  ApproachKind kind = ApproachKind::kAbove;
  double probability = 0;  // that the object is between the fingers
  bool settled = false;    // lowered by them
};

/// Rates grasps of one object; see ProposeGrasps for what a grasp must be and for the score. All
/// references must outlive it.
class GraspEvaluation {
 public:
  GraspEvaluation(const FitResult& fit, const GraspedBody& body, const Standing& standing,
                  const Plane& table_F, const Obstacles& obstacles, const GripperConfig& gripper);

  /// The idea as a grasp, as deep as palm and table allow; none where the gripper cannot, obstacles
  /// left aside.
  std::optional<RatedGrasp> Rate(const GraspIdea& idea) const;

  /// The pinch of a rim, of which `seen` was seen, as a grasp; none where the table is in the way.
  std::optional<RatedGrasp> RatePinch(const RimPinch& pinch, double seen) const;

  /// Takes obstacles and alternatives into account: the score drops or stays. False where an
  /// obstacle is in the way.
  bool Settle(RatedGrasp& rated) const;

 private:
  std::optional<double> Deepest(const GraspIdea& idea, double reach_m) const;
  std::optional<double> Enclose(GraspCandidate& grasp, double spread_m) const;
  double HoldsTurned(const GraspIdea& idea, const Eigen::Vector3d& middle_F) const;
  double Quality(const GraspCandidate& grasp, double slip_rad, double held) const;
  bool WorksFor(const GraspedBody& other, const GraspCandidate& grasp) const;

  const GraspedBody& body_;
  const Standing& standing_;
  const Plane table_F_;
  const Plane floor_F_;  // under the body: the table, or what the body stands on
  const Obstacles& obstacles_;
  const GripperConfig& gripper_;
  PoseSpread spread_;
  std::vector<GraspedBody> alternatives_;
};

}  // namespace beckon::pose
