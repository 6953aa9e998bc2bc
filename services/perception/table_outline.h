// The outline of a table: the convex hull, in the table's plane, of the largest connected piece of
// the points that lie on it.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "services/base/geometry.h"

namespace beckon::perception {

/// Coordinates on a plane: x and y span it, seen from the side its normal points to.
struct PlaneAxes {
  Eigen::Vector3d x, y;
  explicit PlaneAxes(const Plane& plane);
  Eigen::Vector2d operator()(const Eigen::Vector3d& p) const { return {x.dot(p), y.dot(p)}; }
};

/// Counter-clockwise, without collinear vertices (Andrew's monotone chain). Fewer than three
/// vertices where the points lie on a line.
std::vector<Eigen::Vector2d> ConvexHull(std::vector<Eigen::Vector2d> points);

/// Whether `p` lies in a counter-clockwise convex polygon, its border included.
bool Contains(std::span<const Eigen::Vector2d> hull, const Eigen::Vector2d& p);

/// How far inside a counter-clockwise convex polygon `p` lies; negative outside.
double DepthInside(std::span<const Eigen::Vector2d> hull, const Eigen::Vector2d& p);

/// Of `points`, those of the piece that holds most of them, where points within about `gap` belong
/// together. A wall or a chair that happens to cut the table's plane is not the table.
std::vector<Eigen::Vector2d> LargestPiece(std::span<const Eigen::Vector2d> points, double gap);

}  // namespace beckon::perception
