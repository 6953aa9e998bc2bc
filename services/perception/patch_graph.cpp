// One pass over the borders between patches.
#include "services/perception/patch_graph.h"

#include <algorithm>
#include <cmath>

namespace beckon::perception {
namespace {

constexpr float kHardlyTurns = 0.97f;  // cosine of 14 degrees
constexpr int kShadow = 12;            // cells without depth between an occluder and what it hides
constexpr float kMeets = 4;            // standard deviations between surfaces that meet

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

/// Walks from cell to cell and counts what it passes into the edges.
class BorderCounter {
 public:
  BorderCounter(const DepthGrid& grid, const SurfaceCells& cells, const SurfacePatches& patches,
                const SensorNoise& sensor)
      : grid_(grid),
        cells_(cells),
        patches_(patches),
        noise_(sensor),
        edges_(patches.patches.size()) {}

  /// From a cell of a patch to the next cell with depth in the direction (du, dv).
  void Look(int u, int v, int du, int dv) {
    const int a = patches_.patch_of_cell[grid_.Index(u, v)];
    for (int k = 1; k <= kShadow; ++k) {
      const int x = u + k * du, y = v + k * dv;
      if (x >= cells_.part.right || y >= cells_.part.bottom) return;
      const size_t i = grid_.Index(x, y);
      if (grid_.inverse_depth[i] <= 0) continue;
      const int b = patches_.patch_of_cell[i];
      if (b >= 0 && b != a) Count(u, v, x, y, k <= 2);
      return;
    }
  }

  std::vector<PatchEdge> Sorted() { return edges_.Sorted(); }

 private:
  void Count(int u, int v, int x, int y, bool near) {
    const size_t i = grid_.Index(u, v), j = grid_.Index(x, y);
    const int a = patches_.patch_of_cell[i], b = patches_.patch_of_cell[j];
    const float w_i = cells_.inverse_depth[i], w_j = cells_.inverse_depth[j];
    const float off_a = std::abs(w_j - Predict(a, x, y)), off_b = std::abs(w_i - Predict(b, u, v));
    const bool touching = std::min(off_a, off_b) < kMeets * noise_(std::max(w_i, w_j));
    if (touching && !near) return;
    PatchEdge& edge = edges_.At(std::min(a, b), std::max(a, b));
    if (touching) {
      ++edge.n_touching;
    } else if ((a < b) == (w_i > w_j)) {
      ++edge.n_a_before;
    } else {
      ++edge.n_b_before;
    }
  }

  float Predict(int patch, int u, int v) const {
    return patches_.patches[patch].InverseDepth(
        grid_.Ray(static_cast<float>(u), static_cast<float>(v)));
  }

  const DepthGrid& grid_;
  const SurfaceCells& cells_;
  const SurfacePatches& patches_;
  InverseDepthNoise noise_;
  EdgeCollector edges_;
};

}  // namespace

std::vector<PatchEdge> FindEdges(const DepthGrid& grid, const SurfaceCells& cells,
                                 const SurfacePatches& patches, const SensorNoise& sensor) {
  BorderCounter counter(grid, cells, patches, sensor);
  for (int v = cells.part.top; v < cells.part.bottom; ++v) {
    for (int u = cells.part.left; u < cells.part.right; ++u) {
      if (patches.patch_of_cell[grid.Index(u, v)] < 0) continue;
      counter.Look(u, v, 1, 0);
      counter.Look(u, v, 0, 1);
    }
  }
  return counter.Sorted();
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
