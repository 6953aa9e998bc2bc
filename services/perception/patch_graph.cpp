// One pass over the borders between patches.
#include "services/perception/patch_graph.h"

#include <algorithm>
#include <cmath>

namespace beckon::perception {
namespace {

constexpr float kHardlyTurns = 0.97f;  // cosine of 14 degrees
constexpr float kMeets = 4;  // standard deviations between surfaces that meet

/// Collects the edges of each patch in a short list of its own.
class EdgeCollector {
 public:
  explicit EdgeCollector(size_t n_patches) : of_patch_(n_patches) {}

  PatchEdge& At(int a, int b) {
    auto& list = of_patch_[a];
    for (PatchEdge& edge : list) {
      if (edge.b == b) return edge;
    }
    list.push_back({a, b});
    return list.back();
  }

  std::vector<PatchEdge> Sorted() {
    std::vector<PatchEdge> all;
    for (auto& list : of_patch_) {
      std::sort(list.begin(), list.end(),
                [](const PatchEdge& x, const PatchEdge& y) { return x.b < y.b; });
      all.insert(all.end(), list.begin(), list.end());
    }
    return all;
  }

 private:
  std::vector<std::vector<PatchEdge>> of_patch_;
};

}  // namespace

std::vector<PatchEdge> FindEdges(const DepthGrid& grid, const SurfaceCells& cells,
                                 const SurfacePatches& patches, const SensorNoise& sensor) {
  const InverseDepthNoise noise(sensor);
  EdgeCollector edges(patches.patches.size());
  auto look = [&](int u, int v, int u2, int v2) {
    const size_t i = grid.Index(u, v), j = grid.Index(u2, v2);
    int a = patches.patch_of_cell[i], b = patches.patch_of_cell[j];
    if (b < 0 || a == b) return;
    const float w_i = cells.inverse_depth[i], w_j = cells.inverse_depth[j];
    const float off_a = std::abs(
        w_j - patches.patches[a].InverseDepth(grid.Ray(static_cast<float>(u2), static_cast<float>(v2))));
    const float off_b = std::abs(
        w_i - patches.patches[b].InverseDepth(grid.Ray(static_cast<float>(u), static_cast<float>(v))));
    const bool touching = std::min(off_a, off_b) < kMeets * noise(std::max(w_i, w_j));
    const bool i_before = w_i > w_j;
    PatchEdge& edge = edges.At(std::min(a, b), std::max(a, b));
    if (touching) {
      ++edge.n_touching;
    } else if ((a < b) == i_before) {
      ++edge.n_a_before;
    } else {
      ++edge.n_b_before;
    }
  };
  const CellRectangle& part = cells.part;
  for (int v = part.top; v < part.bottom; ++v) {
    for (int u = part.left; u < part.right; ++u) {
      if (patches.patch_of_cell[grid.Index(u, v)] < 0) continue;
      if (u + 1 < part.right) {
        const int step = grid.inverse_depth[grid.Index(u + 1, v)] > 0 ? 1 : 2;
        if (u + step < part.right) look(u, v, u + step, v);
      }
      if (v + 1 < part.bottom) {
        const int step = grid.inverse_depth[grid.Index(u, v + 1)] > 0 ? 1 : 2;
        if (v + step < part.bottom) look(u, v, u, v + step);
      }
    }
  }
  return edges.Sorted();
}

void SteadyNormals(const std::vector<PatchEdge>& edges, SurfacePatches& patches) {
  std::vector<Eigen::Vector3f> sums;
  for (const Patch& p : patches.patches) {
    sums.push_back(p.normal_C * static_cast<float>(p.n_cells));
  }
  for (const PatchEdge& edge : edges) {
    const Patch &a = patches.patches[edge.a], &b = patches.patches[edge.b];
    if (edge.n_touching < 2 || a.normal_C.dot(b.normal_C) < kHardlyTurns) continue;
    sums[edge.a] += b.normal_C * static_cast<float>(b.n_cells);
    sums[edge.b] += a.normal_C * static_cast<float>(a.n_cells);
  }
  for (size_t i = 0; i < sums.size(); ++i) {
    patches.patches[i].steady_normal_C = sums[i].normalized();
  }
}

}  // namespace beckon::perception
