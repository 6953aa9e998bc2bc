// Small flat blocks of the depth grid, of which tables are made.
#pragma once

#include <vector>

#include "services/perception/depth_grid.h"

namespace beckon::perception {

inline constexpr int kBlockCells = 6;  // along a block's edge

/// A block whose cells lie on a plane: w = slope · (x, y, 1) with (x, y, 1) the ray.
struct Block {
  int row, column;                 // of blocks
  float x, y, w;                   // its centre
  float left, top, right, bottom;  // in ray coordinates
  Eigen::Vector3f normal;          // towards the camera
  float noise_m;                   // twice the standard deviation of the depth
};

/// The blocks of the grid, row by row, that have depth in more than half of their cells and whose
/// cells fit a plane within the noise.
std::vector<Block> FlatBlocks(const DepthGrid& grid, const InverseDepthNoise& noise);

}  // namespace beckon::perception
