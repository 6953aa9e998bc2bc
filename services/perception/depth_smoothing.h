// Edge-preserving smoothing of inverse depth.
#pragma once

#include <vector>

#include "services/perception/depth_grid.h"

namespace beckon::perception {

/// Smooths inverse depth within `part` and keeps edges: a cell is averaged with pairs of cells on
/// opposite sides of it whose mean agrees with it within the noise. Planes stay as they are,
/// however tilted, and no pair reaches across an edge. Returns a copy of the grid's inverse depths
/// where these are smoothed.
std::vector<float> SmoothInverseDepth(const DepthGrid& grid, const CellRectangle& part,
                                      const SensorNoise& sensor);

}  // namespace beckon::perception
