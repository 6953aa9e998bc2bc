// What a gripper must not touch: a scene's other objects as points, those seen and those of their
// hidden sides.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include "services/pose/fit.h"
#include "services/pose/grasp_gripper.h"

namespace beckon::pose {

/// Points of one object in a frame F and the sphere around them.
struct Obstacle {
  Eigen::Array<float, Eigen::Dynamic, 3>
      points_F;  // m; a whole number of blocks of kBlock, or none
  Eigen::Vector3f centre_F = Eigen::Vector3f::Zero();
  float radius_m = 0;

  static constexpr int kBlock = 8;
};

/// The obstacle that an object is: its points, thinned so that each has one within `clearance_m`
/// that is kept, and, where its fit converged, points of the fitted surface at about that distance.
/// NaN and infinite points are left out.
Obstacle MakeObstacle(std::span<const Eigen::Vector3f> points_F, const FitResult& fit,
                      double clearance_m);

/// The obstacles of an object: those of the whole scene, without itself.
struct Obstacles {
  std::span<const Obstacle> scene;
  size_t except = std::numeric_limits<size_t>::max();  // index of the object itself in `scene`
};

/// Distance of the nearest obstacle from `hand`, measured along the axes of G (never more than the
/// Euclidean distance), m, or `enough_m` where none is nearer. Below `too_near_m` it is exact no
/// more: the search ends there.
double DistanceToObstacles(const Obstacles& obstacles, const std::array<HandBox, 2>& hand,
                           const Pose& X_FG, double too_near_m, double enough_m);

}  // namespace beckon::pose
