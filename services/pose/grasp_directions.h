// From where, at which height and across which direction a standing object may be grasped.
#pragma once

#include <vector>

#include "services/pose/grasp_contacts.h"
#include "services/pose/grasp_gripper.h"

namespace beckon::pose {

enum class ApproachKind { kAbove, kSide, kTilted, kRim };
inline constexpr int kApproachKinds = 4;

/// Where the gripper would go if nothing were in its way.
struct GraspIdea {
  ApproachKind kind = ApproachKind::kAbove;
  Eigen::Vector3d approach_F, closing_F;  // unit, orthogonal
  Eigen::Vector3d middle_F;               // between the contacts
};

/// A body on a table.
struct Standing {
  Eigen::Vector3d up;      // in F
  double bottom_m, top_m;  // above the table; a bottom below it counts as on it
  Eigen::Vector3d narrow;  // horizontal unit vectors, orthogonal: across the narrower of two
  Eigen::Vector3d wide;    // principal directions, and along the wider
  double half_narrow_m, half_wide_m;
};

/// For a body that is round about the vertical, whose principal directions say nothing, `narrow` is
/// F's x axis along the table (its y axis where x is upright).
Standing StandOn(const GraspedBody& body, const Plane& table_F);

/// Straight down, closing across all directions of the half circle, at several places along long
/// bodies; from the sides all around, closing horizontally, at several heights where the palm fits
/// between table and top; and from halfway between.
/// Always in the same order.
std::vector<GraspIdea> FindDirections(const GraspedBody& body, const Standing& standing,
                                      const GripperConfig& gripper);

}  // namespace beckon::pose
