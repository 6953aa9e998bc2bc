// The outline of an object as rays that graze it, and the straight pieces of it that may be where
// something cuts the object off.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "services/base/geometry.h"
#include "services/base/rim.h"
#include "services/pose/distance_kernel.h"
#include "services/pose/fit_stage.h"
#include "services/pose/outline_straights.h"

namespace beckon::pose {

struct SilhouetteConfig {
  int most_rays = 96;
  double pixel_rad = 1.0 / 525;   // the outline runs half a pixel outside the outermost points
  double table_margin_m = 0.015;  // outline this near the table is the table's doing
};

struct Silhouette {
  PointBlock rays_F;  // unit directions from the viewpoint; weights sum to 1
  // Where nobody knows what lies beyond the outline: pieces of it that may be cuts, longest first.
  std::vector<Straight> straights;
  // Where it is known: the sides on which occluders or the image's border cut the object off, the
  // longest first; no rays.
  std::vector<Straight> cuts;
};

/// The outline of `points_F` as seen from the viewpoint. Where `rim_F` tells what lies beyond, the
/// rays are those of rim points with the background beyond them. Without, they are those of the
/// outermost points of each row and column of a grid of pixels, whatever may lie beyond. Empty
/// where the viewpoint is among the points.
Silhouette TraceSilhouette(std::span<const Eigen::Vector3d> points_F,
                           std::span<const RimPoint> rim_F, const Eigen::Vector3d& viewpoint_F,
                           const std::optional<Plane>& table_F, const SilhouetteConfig& config);

}  // namespace beckon::pose
