// From labelled cells to labelled pixels.
#pragma once

#include <cstdint>
#include <vector>

#include "services/perception/surface_patches.h"

namespace beckon::perception {

/// Labels the pixels of `image` (all 0 before) that lie in or beside a labelled cell: by the cell
/// it lies in, or by the neighbouring cell whose surface it lies on; 0 = none. Used cells without a
/// label take that of a neighbour on the same surface first.
void LabelPixels(const RgbdImage& image, const DepthGrid& grid, const SurfaceCells& cells,
                 std::vector<uint16_t> label_of_cell, const SensorNoise& sensor,
                 std::vector<uint16_t>& labels);

}  // namespace beckon::perception
