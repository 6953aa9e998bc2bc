// Pixels take the label of the nearest cell on their surface.
#include "services/perception/label_pixels.h"

#include <algorithm>
#include <cmath>

namespace beckon::perception {
namespace {

constexpr float kSameSurface = 6;  // standard deviations between neighbours on one surface
constexpr int kSpread = 4;         // cells a label may spread over cells without one

/// Gives labels to used cells that no patch took, from their neighbours.
void FillCells(const DepthGrid& grid, const SurfaceCells& cells, const InverseDepthNoise& noise,
               std::vector<uint16_t>& label) {
  const CellRectangle& part = cells.part;
  for (int pass = 0; pass < kSpread; ++pass) {
    std::vector<std::pair<size_t, uint16_t>> found;
    for (int v = std::max(1, part.top); v < std::min(grid.height - 1, part.bottom); ++v) {
      for (int u = std::max(1, part.left); u < std::min(grid.width - 1, part.right); ++u) {
        const size_t i = grid.Index(u, v);
        if (!cells.used[i] || label[i] != 0) continue;
        const float w = cells.inverse_depth[i];
        float least = kSameSurface * noise(w);
        uint16_t best = 0;
        for (const size_t j : {i - 1, i + 1, i - grid.width, i + grid.width}) {
          const float off = std::abs(cells.inverse_depth[j] - w);
          if (label[j] != 0 && off < least) least = off, best = label[j];
        }
        if (best != 0) found.emplace_back(i, best);
      }
    }
    if (found.empty()) break;
    for (const auto& [i, l] : found) label[i] = l;
  }
}

}  // namespace

std::vector<uint16_t> LabelPixels(const RgbdImage& image, const DepthGrid& grid,
                                  const SurfaceCells& cells, std::vector<uint16_t> label_of_cell,
                                  const SensorNoise& sensor) {
  const InverseDepthNoise noise(sensor);
  FillCells(grid, cells, noise, label_of_cell);
  std::vector<uint16_t> labels(image.depth_m.size(), 0);
  const int p = grid.pixels;
  const int left = std::max(1, cells.part.left - 1),
            right = std::min(grid.width - 1, cells.part.right + 1);
  const int top = std::max(1, cells.part.top - 1),
            bottom = std::min(grid.height - 1, cells.part.bottom + 1);
  for (int cv = top; cv < bottom; ++cv) {
    for (int cu = left; cu < right; ++cu) {
      const size_t i = grid.Index(cu, cv);
      const size_t near[9] = {i,
                              i - 1,
                              i + 1,
                              i - grid.width,
                              i + grid.width,
                              i - grid.width - 1,
                              i - grid.width + 1,
                              i + grid.width - 1,
                              i + grid.width + 1};
      if (std::none_of(near, near + 9, [&](size_t j) { return label_of_cell[j] != 0; })) continue;
      for (int y = 0; y < p; ++y) {
        for (int x = 0; x < p; ++x) {
          const size_t pixel = image.Index(cu * p + x, cv * p + y);
          const float depth_m = image.depth_m[pixel];
          if (!(depth_m > 0 && depth_m < 100)) continue;
          const float w = 1 / depth_m, limit = kSameSurface * noise(w);
          for (const size_t j : near) {
            if (std::abs(grid.inverse_depth[j] - w) > limit) continue;
            labels[pixel] = label_of_cell[j];
            break;
          }
        }
      }
    }
  }
  return labels;
}

}  // namespace beckon::perception
