// An object as a union of superquadrics: how well it explains points, and its refit.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "services/base/rim.h"
#include "services/pose/adaptive_problem.h"
#include "services/pose/distance_kernel.h"
#include "services/pose/superquadric.h"

namespace beckon::pose {

/// What is known of an object whose parts are looked for.
struct PartsView {
  PointBlock points_F;              // a sample of the object's
  PointBlock rays_F;                // its outline, unit directions; empty until a part is tried
  std::span<const RimPoint> rim_F;  // what the image shows around it; empty where not known
  TableTopScene scene;
  Eigen::Vector3d up;    // unit, F
  double noise_m = 0;    // the camera's, at the object's distance
  double outside_m = 0;  // points farther outside stick out

  /// Distance beyond which a point counts as foreign, not as one that the shape misses.
  double foreign_m() const { return 3 * outside_m; }
};

struct PartModel {
  std::vector<Superquadric> parts;          // the main body first
  std::vector<BlockDistances> distances_m;  // of every point from every part, signed
  double variance_m2 = 0;                   // the camera's and that of the points about the union

  /// Signed distance of point `i` from the union: that of the part it is deepest in or nearest to.
  float DistanceOf(int i) const;
  /// The part whose surface is nearest to point `i`.
  size_t Nearest(int i) const;
};

/// The model with its distances and variance, in which each point's distance is cut off at
/// `foreign_m`.
PartModel Judge(std::vector<Superquadric> parts, const PartsView& view, double foreign_m);

/// The variance of a model whose distances are known.
double Variance(const PartModel& model, const PartsView& view, double foreign_m);

/// Whether the ray to each of `points_F` passes `depth_m` deep through the shape before it gets
/// there: the camera would not see the point, were the shape solid there.
std::vector<bool> SeenThrough(const Superquadric& shape, const Eigen::Vector3d& viewpoint_F,
                              const PointBlock& points_F, double depth_m);

/// Every part refitted to the points, and the outline's rays, that are nearest to it. The main body
/// is held to the table, the others are not.
std::vector<Superquadric> Refit(const PartModel& model, const PartsView& view,
                                const AdaptiveConfig& fit, int iterations, double min_semi_axis_m);

/// One shape fitted to a few points from a start; not held to the table.
Superquadric FitLoosePart(const PointBlock& points_F, const PartsView& view,
                          const Superquadric& start, const AdaptiveConfig& fit, int iterations,
                          double min_semi_axis_m);

}  // namespace beckon::pose
