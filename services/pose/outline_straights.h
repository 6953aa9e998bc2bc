// Straight pieces of an outline in the image: edges of a box, or where something cuts the object
// off.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "services/base/rim.h"

namespace beckon::pose {

/// A straight piece of the outline: the edge of a box, or where something cuts the object off.
struct Straight {
  std::vector<int> rays;       // indices
  Eigen::Vector3d normal_F;    // of the plane through the viewpoint and the piece; unit, outward
  double mean_square_rad = 0;  // of the rays about that plane
  double width_rad = 0;        // of the object as seen, across the piece
};

/// The z component of the cross product; positive where b is counter-clockwise of a.
double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b);

/// Counter-clockwise (Andrew's monotone chain).
std::vector<Eigen::Vector2d> ConvexHull(std::vector<Eigen::Vector2d> points);

/// The straight pieces of an outline, px, and its hull, longest first. Columns of `to_F`: the axes
/// of the image plane and the line of sight, in F.
std::vector<Straight> FindStraights(const std::vector<Eigen::Vector2d>& outline,
                                    const std::vector<Eigen::Vector2d>& hull, double pixel_rad,
                                    const Eigen::Matrix3d& to_F);

/// The longest pieces of the rim that occluders or the image's border take away; gaps of a point or
/// two in them do not count. `image`: the rim's points, px; `turn`: 1 where they run
/// counter-clockwise, else -1. No rays.
std::vector<Straight> FindCuts(std::span<const RimPoint> rim_F,
                               const std::vector<Eigen::Vector2d>& image, double turn,
                               double pixel_rad, const Eigen::Matrix3d& axes);

}  // namespace beckon::pose
