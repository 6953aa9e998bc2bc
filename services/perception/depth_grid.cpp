// Reduction of the depth image, row by row.
#include "services/perception/depth_grid.h"

#include <algorithm>
#include <cmath>

namespace beckon::perception {
namespace {

constexpr double kCellAngle = 1 / 262.5;  // rad
constexpr int kMostPixels = 8;
constexpr float kSameSurface = 6;  // standard deviations between pixels of one surface in a cell

/// Inverse depths of a row of pixels, 0 where out of range (or no number: comparisons with NaN
/// fail). Returns how many are in range.
int InvertRow(const float* depth_m, int n, float min_m, float max_m, float* inverse) {
  int in_range = 0;
  for (int u = 0; u < n; ++u) {
    const bool good = depth_m[u] >= min_m && depth_m[u] <= max_m;
    inverse[u] = 1 / (good ? depth_m[u] : 1e30f);
    in_range += good;
  }
  for (int u = 0; u < n; ++u) inverse[u] = inverse[u] > 1e-20f ? inverse[u] : 0;
  return in_range;
}

/// One row of cells from `pixels` rows of inverse depths that lie `row_size` apart.
template <int kPixels>
void ReduceRows(const float* rows, int row_size, int pixels, int n, const InverseDepthNoise& noise,
                float* out) {
  const int p = kPixels > 0 ? kPixels : pixels;
  for (int u = 0; u < n; ++u) {
    const float* cell = rows + static_cast<size_t>(u) * p;
    float nearest = 0;
    for (int y = 0; y < p; ++y) {
      for (int x = 0; x < p; ++x) nearest = std::max(nearest, cell[y * row_size + x]);
    }
    const float least = nearest - kSameSurface * noise(nearest);
    float sum = 0, count = 0;
    for (int y = 0; y < p; ++y) {
      for (int x = 0; x < p; ++x) {
        const float w = cell[y * row_size + x];
        const float same = w > least && w > 0 ? 1.0f : 0.0f;
        sum += same * w;
        count += same;
      }
    }
    out[u] = sum / std::max(count, 1.0f);
  }
}

}  // namespace

int PixelsPerCell(const Intrinsics& intrinsics) {
  const double focal_px = std::min(intrinsics.fx, intrinsics.fy);
  return std::clamp(static_cast<int>(std::lround(focal_px * kCellAngle)), 1, kMostPixels);
}

DepthGrid MakeDepthGrid(const RgbdImage& image, double min_range_m, double max_range_m,
                        const SensorNoise& sensor) {
  DepthGrid grid;
  const int p = grid.pixels = PixelsPerCell(image.intrinsics);
  grid.width = image.width / p;
  grid.height = grid.width > 0 ? image.height / p : 0;  // narrower than a cell: no cells at all
  const double centre = (p - 1) / 2.0;
  grid.fx = static_cast<float>(image.intrinsics.fx / p);
  grid.fy = static_cast<float>(image.intrinsics.fy / p);
  grid.cx = static_cast<float>((image.intrinsics.cx - centre) / p);
  grid.cy = static_cast<float>((image.intrinsics.cy - centre) / p);
  grid.inverse_depth.resize(static_cast<size_t>(grid.width) * grid.height);
  const InverseDepthNoise noise(sensor);
  const float min_m = std::max(1e-3f, static_cast<float>(min_range_m));
  const float max_m = static_cast<float>(max_range_m);
  std::vector<float> rows(static_cast<size_t>(p) * image.width);
  for (int v = 0; v < grid.height; ++v) {
    for (int y = 0; y < p; ++y) {
      grid.n_pixels += InvertRow(&image.depth_m[image.Index(0, v * p + y)], image.width, min_m,
                                 max_m, &rows[static_cast<size_t>(y) * image.width]);
    }
    float* out = &grid.inverse_depth[grid.Index(0, v)];
    const auto reduce = p == 1 ? ReduceRows<1> : p == 2 ? ReduceRows<2> : ReduceRows<0>;
    reduce(rows.data(), image.width, p, grid.width, noise, out);
  }
  return grid;
}

}  // namespace beckon::perception
