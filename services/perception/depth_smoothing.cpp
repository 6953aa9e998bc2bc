// Pairs of opposite cells, along rows and along columns in turn.
#include "services/perception/depth_smoothing.h"

#include <algorithm>
#include <cmath>

namespace beckon::perception {
namespace {

constexpr int kReach = 3;        // cells to either side
constexpr int kPasses = 2;       // of both directions
constexpr float kAgrees = 2.5f;  // standard deviations that a pair's mean may be off
constexpr float kSteepest = 24;  // standard deviations a cell that a smooth surface may change

/// Averages each cell of a row with the pairs `stride` cells apart that agree with it. All the
/// cells that are read must exist.
void SmoothRow(const float* in, int n, int stride, const InverseDepthNoise& noise, float* out) {
  for (int u = 0; u < n; ++u) {
    const float w = in[u];
    const float sigma = noise(w);
    float sum = w, count = 1;
    for (int k = 1; k <= kReach; ++k) {
      const float a = in[u - k * stride], b = in[u + k * stride];
      const float bend = std::abs(a + b - 2 * w), rise = std::abs(a - b);
      const float agrees =
          (bend < 2 * kAgrees * sigma ? 1.0f : 0.0f) * (rise < k * kSteepest * sigma ? 1.0f : 0.0f);
      sum += agrees * (a + b);
      count += 2 * agrees;
    }
    out[u] = sum / count;
  }
}

}  // namespace

std::vector<float> SmoothInverseDepth(const DepthGrid& grid, const CellRectangle& part,
                                      const SensorNoise& sensor) {
  const InverseDepthNoise noise(sensor);
  std::vector<float> smooth = grid.inverse_depth, across = grid.inverse_depth;
  const int left = std::max(part.left, kReach), right = std::min(part.right, grid.width - kReach);
  const int top = std::max(part.top, kReach), bottom = std::min(part.bottom, grid.height - kReach);
  const int n = right - left;
  if (n <= 0) return smooth;
  for (int pass = 0; pass < kPasses; ++pass) {
    for (int v = part.top; v < part.bottom; ++v) {
      SmoothRow(&smooth[grid.Index(left, v)], n, 1, noise, &across[grid.Index(left, v)]);
    }
    for (int v = top; v < bottom; ++v) {
      SmoothRow(&across[grid.Index(left, v)], n, grid.width, noise, &smooth[grid.Index(left, v)]);
    }
  }
  return smooth;
}

}  // namespace beckon::perception
