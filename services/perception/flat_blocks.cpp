// Least squares on each block.
#include "services/perception/flat_blocks.h"

#include <algorithm>
#include <optional>

namespace beckon::perception {
namespace {

constexpr float kFlat = 3;          // standard deviations that a flat block's cells may be off
constexpr float kFewestCells = 20;  // with depth, of a block

/// Sums over the cells of a block that have depth; u and v count from its middle.
struct BlockSums {
  float n = 0, u = 0, v = 0, w = 0, uu = 0, uv = 0, vv = 0, uw = 0, vw = 0, ww = 0;
};

BlockSums SumBlock(const DepthGrid& grid, int left, int top) {
  BlockSums s;
  for (int y = 0; y < kBlockCells; ++y) {
    const float* row = &grid.inverse_depth[grid.Index(left, top + y)];
    const float v = static_cast<float>(y) - (kBlockCells - 1) / 2.0f;
    for (int x = 0; x < kBlockCells; ++x) {
      const float w = row[x], one = w > 0 ? 1.0f : 0.0f;
      const float u = static_cast<float>(x) - (kBlockCells - 1) / 2.0f;
      s.n += one, s.w += w, s.u += one * u, s.v += one * v;
      s.uu += one * u * u, s.uv += one * u * v, s.vv += one * v * v;
      s.uw += u * w, s.vw += v * w, s.ww += w * w;
    }
  }
  return s;
}

std::optional<Block> FitBlock(const DepthGrid& grid, int left, int top,
                              const InverseDepthNoise& noise) {
  const BlockSums s = SumBlock(grid, left, top);
  if (s.n < kFewestCells) return std::nullopt;
  const float u = s.u / s.n, v = s.v / s.n, w = s.w / s.n;
  const float uu = s.uu / s.n - u * u, uv = s.uv / s.n - u * v, vv = s.vv / s.n - v * v;
  const float uw = s.uw / s.n - u * w, vw = s.vw / s.n - v * w;
  const float det = uu * vv - uv * uv;
  if (det < 1) return std::nullopt;  // all on a line
  const float a = (uw * vv - vw * uv) / det, b = (vw * uu - uw * uv) / det;
  const float limit = kFlat * noise(w);
  float residual = 0;
  for (int y = 0; y < kBlockCells; ++y) {
    const float* row = &grid.inverse_depth[grid.Index(left, top + y)];
    const float from_v = static_cast<float>(y) - (kBlockCells - 1) / 2.0f - v;
    for (int x = 0; x < kBlockCells; ++x) {
      const float from_u = static_cast<float>(x) - (kBlockCells - 1) / 2.0f - u;
      const float off = row[x] > 0 ? row[x] - w - a * from_u - b * from_v : 0;
      residual += off * off;
    }
  }
  if (residual > s.n * limit * limit) return std::nullopt;
  const float half = (kBlockCells - 1) / 2.0f;
  const Eigen::Vector3f low = grid.Ray(static_cast<float>(left), static_cast<float>(top));
  const Eigen::Vector3f centre =
      grid.Ray(static_cast<float>(left) + half + u, static_cast<float>(top) + half + v);
  const Eigen::Vector3f slope(a * grid.fx, b * grid.fy,
                              w - a * grid.fx * centre.x() - b * grid.fy * centre.y());
  return Block{top / kBlockCells,
               left / kBlockCells,
               centre.x(),
               centre.y(),
               w,
               low.x(),
               low.y(),
               low.x() + (kBlockCells - 1) / grid.fx,
               low.y() + (kBlockCells - 1) / grid.fy,
               -slope.normalized(),
               2 * noise(w) / (w * w)};
}

}  // namespace

std::vector<Block> FlatBlocks(const DepthGrid& grid, const InverseDepthNoise& noise) {
  std::vector<Block> blocks;
  for (int v = 0; v + kBlockCells <= grid.height; v += kBlockCells) {
    for (int u = 0; u + kBlockCells <= grid.width; u += kBlockCells) {
      if (auto block = FitBlock(grid, u, v, noise)) blocks.push_back(*block);
    }
  }
  return blocks;
}

}  // namespace beckon::perception
