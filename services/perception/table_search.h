// Finds the plane of the table among a scene's planes by RANSAC (PCL).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/perception/segmentation.h"

namespace beckon::perception {

struct TableSearch {
  std::optional<Plane> table_C;   // normal towards the camera
  std::vector<uint32_t> inliers;  // indices of the points on it, ascending
  std::string reason;             // where there is none
  int planes_tried = 0;
};

/// The largest plane that can be a table: of enough points, not a wall (its normal must lean no
/// more than table_max_tilt_deg from up in the image), and with no other such plane more than
/// max_height_m above it (then the lower one is the floor). Deterministic.
TableSearch FindTable(std::span<const Eigen::Vector3f> points_C, const SegmentationConfig& config,
                      const StepObserver& done);

}  // namespace beckon::perception
