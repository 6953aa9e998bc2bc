// Finds the table's plane among small flat blocks of the depth grid.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/perception/depth_grid.h"
#include "services/perception/segmentation.h"

namespace beckon::perception {

/// The table of a grid, or why there is none.
struct TablePlane {
  std::optional<Plane> table_C;          // normal towards the camera
  std::vector<Eigen::Vector2d> outline;  // convex, in PlaneAxes(*table_C), counter-clockwise
  std::string reason;
  int n_pixels = 0;  // of flat blocks on it
};

/// The plane that most flat blocks of the grid lie on, by place and by normal, among those a table
/// can have (table_max_tilt_deg, plane_min_points). Where a parallel plane with a twentieth of the
/// blocks lies more than max_height_m above it, that one is the table and the lower one the floor.
/// None is, where the camera is upside down by all appearances: one that is seen from below is far
/// larger.
/// RANSAC (Fischler & Bolles 1981) with a fixed seed over blocks instead of points, then least
/// squares. The outline is the convex hull of the largest connected piece of the blocks (gaps up to
/// table_gap_m), so that neither walls, chairs nor a second table widen it. Deterministic.
TablePlane FindTablePlane(const DepthGrid& grid, const SegmentationConfig& config);

}  // namespace beckon::perception
