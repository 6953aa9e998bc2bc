// Thins an image's points to one per voxel, and remembers which voxel each pixel went to.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "services/base/rgbd.h"

namespace beckon::perception {

struct VoxelGrid {
  static constexpr uint32_t kNone = 0xffffffff;

  std::vector<Eigen::Vector3f>
      points_C;  // mean of each voxel's points, in order of first appearance
  std::vector<uint32_t> voxel_of_pixel;  // width * height, index into points_C, or kNone
  int n_pixels = 0;                      // in range
};

/// Voxels of edge `voxel_m` over the pixels whose depth is within [min_range_m, max_range_m]. The
/// grid is not bounded (PCL's VoxelGrid gives up where its box holds more than 2^31 cells: 2.6 m at
/// 2 mm).
VoxelGrid MakeVoxelGrid(const RgbdImage& image, double voxel_m, double min_range_m,
                        double max_range_m);

}  // namespace beckon::perception
