// Pictures of fits: every cloud as the camera saw it and from the side that the camera did not see.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/base/rgbd.h"
#include "services/pose/estimate.h"

namespace beckon::pose {

/// What one tile shows, all in one frame F.
struct Portrait {
  std::string title;
  std::vector<Eigen::Vector3f> points_F;
  std::optional<Plane> table_F;
  Eigen::Vector3d viewpoint_F = Eigen::Vector3d::Zero();
  Estimate estimate;
};

/// How many portraits a picture holds; the rest is counted below it.
inline constexpr size_t kMostPortraits = 64;
/// Sizes, px: a tile, and the legend below all of them.
inline constexpr int kTileWidth_px = 720, kTileHeight_px = 360, kLegendHeight_px = 36;

/// Writes a picture of tiles, at most four a row, with a legend below. A tile has the camera's view
/// on the left and one turned by 90 degrees about the table's normal (without a table: the image's
/// vertical) on the right. Both show the points coloured by their distance to the surface, the
/// wireframe (what is hidden lighter; orange where the fit did not converge; each part in a colour
/// of its own), alternatives dashed, the axes of frame O and the best grasp.
Status DrawPortraits(const std::string& path, const std::vector<Portrait>& portraits,
                     const GripperConfig& gripper);

/// A fit in words, for pictures: semi-axes, exponents and residual, or why it did not converge.
std::string Describe(const FitResult& fit);

}  // namespace beckon::pose
