// Candidate grasps of a fitted object for a parallel gripper.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "services/base/geometry.h"
#include "services/pose/fit.h"
#include "services/pose/grasp_gripper.h"
#include "services/pose/grasp_obstacles.h"

namespace beckon::pose {

inline constexpr int kMostGrasps = 16;  // what a message carries

/// A pose of frame G: z = approach direction, x = closing direction, origin between the finger
/// tips.
struct GraspCandidate {
  Pose X_FG = Pose::Identity();
  double opening_m = 0;                         // before closing
  double score = 0;                             // 0..1
  std::array<Eigen::Vector3d, 2> contacts_F{};  // on the surface, towards +x of G and towards -x
};

/// Antipodal grasps of `fit`, best first, at most kMostGrasps, no two of them nearly the same; none
/// where the fit did not converge. In each of them
///  - both contacts hold by friction (the closing direction within max_slip_rad of the surface
///    normals), and all of the object that the fingers pass fits between them with the clearance;
///  - the gripper, on its straight approach and at the grasp, stays clear of the table, of the
///    obstacles, and its palm of the object.
///
/// The score is P A Q: P, the probability that the object is where the fingers reach it and between
/// them, by the fit's covariance (a Gaussian's tails beyond the gaps on either side, and before and
/// behind the fingers; times the share of its turns, none and one standard deviation either way, at
/// which the contacts hold); A, the share of the shapes that the grasp works for, of the fitted one
/// and its alternatives; and
///   Q = 0.25 (1 - slip / max_slip) + 0.25 / (1 + distance of the contacts' middle from the
///       centroid / finger depth) + 0.2 (what is left of the opening / max_opening)
///       + 0.15 (how far the object reaches into the fingers / all it could)
///       + 0.15 (clearance from obstacles beyond what is asked / twice what is asked, at most 1).
///
/// Where `points_F`, those of the object, show an open vessel, its wall is pinched from above too,
/// at places of the rim that were seen. Of such a grasp the points tell all, not the fit: contacts
/// and slip are those of the wall, P is the share of the rim that was seen, and A is 1.
std::vector<GraspCandidate> ProposeGrasps(const FitResult& fit,
                                          std::span<const Eigen::Vector3f> points_F,
                                          const Plane& table_F, const Obstacles& obstacles,
                                          const GripperConfig& gripper);

}  // namespace beckon::pose
