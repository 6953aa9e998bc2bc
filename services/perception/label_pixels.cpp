// Pixels take the label of the nearest cell on their surface.
#include "services/perception/label_pixels.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace beckon::perception {
namespace {

constexpr float kSameSurface = 6;  // standard deviations between neighbours on one surface
constexpr float kMost_m = 1000;    // infinity is no depth
constexpr int kSpread = 4;         // cells a label may spread over cells without one

/// Gives labels to used cells that no patch took, from their neighbours.
void FillCells(const DepthGrid& grid, const SurfaceCells& cells, const InverseDepthNoise& noise,
               std::vector<uint16_t>& label) {
  const CellRectangle& part = cells.part;
  std::vector<size_t> bare;
  for (int v = std::max(1, part.top); v < std::min(grid.height - 1, part.bottom); ++v) {
    for (int u = std::max(1, part.left); u < std::min(grid.width - 1, part.right); ++u) {
      const size_t i = grid.Index(u, v);
      if (cells.used[i] && label[i] == 0) bare.push_back(i);
    }
  }
  std::vector<std::pair<size_t, uint16_t>> found;
  for (int pass = 0; pass < kSpread; ++pass) {
    found.clear();
    for (size_t i : bare) {
      const float w = cells.inverse_depth[i];
      float least = kSameSurface * noise(w);
      uint16_t best = 0;
      for (const size_t j : {i - 1, i + 1, i - grid.width, i + grid.width}) {
        const float off = std::abs(cells.inverse_depth[j] - w);
        if (label[j] != 0 && off < least) least = off, best = label[j];
      }
      if (best != 0) found.emplace_back(i, best);
    }
    if (found.empty()) break;
    for (const auto& [i, l] : found) label[i] = l;
    std::erase_if(bare, [&](size_t i) { return label[i] != 0; });
  }
}

/// The label of the first of some cells whose surface a depth lies on; 0 = none.
uint16_t LabelAt(const DepthGrid& grid, const std::vector<uint16_t>& label_of_cell,
                 std::span<const size_t> near, const InverseDepthNoise& noise, float depth_m) {
  const float w = 1 / depth_m, limit = kSameSurface * noise(w);
  for (const size_t j : near) {
    if (std::abs(grid.inverse_depth[j] - w) <= limit) return label_of_cell[j];
  }
  return 0;
}

}  // namespace

void LabelPixels(const RgbdImage& image, const DepthGrid& grid, const SurfaceCells& cells,
                 std::vector<uint16_t> label_of_cell, const SensorNoise& sensor,
                 std::vector<uint16_t>& labels) {
  const InverseDepthNoise noise(sensor);
  FillCells(grid, cells, noise, label_of_cell);
  const int p = grid.pixels;
  const auto row = static_cast<size_t>(grid.width);
  const int left = std::max(1, cells.part.left - 1);
  const int right = std::min(grid.width - 1, cells.part.right + 1);
  const int top = std::max(1, cells.part.top - 1);
  const int bottom = std::min(grid.height - 1, cells.part.bottom + 1);
  for (int cv = top; cv < bottom; ++cv) {
    for (int cu = left; cu < right; ++cu) {
      const size_t i = grid.Index(cu, cv);
      const size_t near[9] = {i,           i - 1,       i + 1,       i - row,    i + row,
                              i - row - 1, i - row + 1, i + row - 1, i + row + 1};
      if (std::none_of(near, near + 9, [&](size_t j) { return label_of_cell[j] != 0; })) continue;
      for (int y = 0; y < p; ++y) {
        for (int x = 0; x < p; ++x) {
          const size_t pixel = image.Index(cu * p + x, cv * p + y);
          const float depth_m = image.depth_m[pixel];
          if (!(depth_m > 0 && depth_m < kMost_m)) continue;
          labels[pixel] = LabelAt(grid, label_of_cell, near, noise, depth_m);
        }
      }
    }
  }
}

}  // namespace beckon::perception
