// What the methods share: their outcome, voxel grids, principal axes.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "services/pose/levenberg_marquardt.h"
#include "services/pose/superquadric.h"

namespace beckon::pose {

using PointList = std::vector<Eigen::Vector3d>;

/// A fit whose error is below this many times the best one's, and whose surface lies farther than
/// this from the best one's on average, makes the best one ambiguous.
inline constexpr double kAboutAsGood = 1.1;
inline constexpr double kOtherShape_m = 0.005;

/// What a method makes of sound points.
struct MethodOutcome {
  Superquadric shape;
  bool converged = false;  // the last minimisation came to rest
  bool ambiguous = false;
  std::vector<int> iterations;
  std::vector<Superquadric> alternatives;  // what makes it ambiguous, best first; may be empty
  // Where the method knows it: the information on its parameters, of which the covariance is the
  // inverse.
  std::optional<ParameterMatrix> information;
};

/// At most about `count` points: every so manieth.
PointList Thinned(const PointList& points, int count);

/// The centroid of the points in each voxel of a grid, in the order of the voxels' first points.
PointList VoxelCentroids(const PointList& points, double voxel_m);

/// Centroid, principal axes (columns, right-handed, largest spread first) and the points' box along
/// them.
struct PrincipalBox {
  Eigen::Vector3d centroid;
  Eigen::Matrix3d axes;
  Eigen::Vector3d spread;        // m, standard deviations along the axes
  Eigen::Vector3d half_extents;  // m
  Eigen::Vector3d middle;        // of the box
};
PrincipalBox ComputePrincipalBox(const PointList& points);

/// Distances of points from the surface to first order, (g - 1) / |grad g| (Taubin 1991): the
/// radial distance corrected by the angle between ray and normal. Jacobian to first order in the
/// distance.
struct SurfaceDistance {
  double distance_m;  // positive outside
  ParameterVector jacobian;
};
SurfaceDistance DistanceToSurface(const Superquadric& shape, const Eigen::Vector3d& p_F);

}  // namespace beckon::pose
