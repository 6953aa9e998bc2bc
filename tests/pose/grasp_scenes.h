// Objects on a table for the tests of grasps, and what a gripper fills.
#pragma once

#include <random>
#include <span>
#include <vector>

#include "services/pose/grasps.h"
#include "tests/pose/views.h"

namespace beckon::pose {

inline const Plane kTable;  // z = 0 of W
inline const GripperConfig kGripper;

/// The fit of a shape that is known this well.
FitResult Known(const Superquadric& shape, double sigma_m = 0.001, double sigma_rad = 0.005);

/// Grasps of a well known shape on kTable by kGripper.
std::vector<GraspCandidate> Propose(const Superquadric& shape,
                                    std::span<const Obstacle> others = {});

/// A shape of any kind and size that stands, lies or leans on the table, within 1 m of the origin.
Superquadric RandomShape(std::mt19937& engine);

Obstacle ObstacleOf(const Superquadric& shape, int points = 1000);

/// Whether a point in G is in the steel of the gripper, somewhere on its way.
bool InGripper(const GraspCandidate& grasp, const Eigen::Vector3d& p_G);

}  // namespace beckon::pose
