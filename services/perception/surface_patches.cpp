// Normals, k-means, and the planes of the patches.
#include "services/perception/surface_patches.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace beckon::perception {
namespace {

constexpr int kIterations = 3;
constexpr int kFewestSeedCells = 5;
constexpr float kNormalWeight = 5;     // of |n - n_patch|^2
constexpr float kPlaneWeight = 0.12f;  // of (distance from the plane / sigma)^2
constexpr float kOffPlane = 6;         // standard deviations: another surface
constexpr int kFewestCells = 4;

/// What k-means holds of a patch.
struct Seed {
  float u, v, w;
  Eigen::Vector3f normal;
};

/// The slope of inverse depth at a cell along `stride`: the mean of both sides where these agree,
/// else the flatter one; `limit` is how much they may differ.
float SlopeAt(const float* w, int stride, float limit) {
  const float back = (w[0] - w[-2 * stride]) * 0.5f;
  const float forth = (w[2 * stride] - w[0]) * 0.5f;
  const float flatter = std::abs(back) < std::abs(forth) ? back : forth;
  return std::abs(back - forth) < limit ? (back + forth) * 0.5f : flatter;
}

std::vector<Seed> PlaceSeeds(const DepthGrid& grid, const SurfaceCells& cells) {
  std::vector<Seed> seeds;
  for (int top = cells.part.top; top < cells.part.bottom; top += kPatchCells) {
    for (int left = cells.part.left; left < cells.part.right; left += kPatchCells) {
      int n = 0, best_u = 0, best_v = 0, best = 1000;
      for (int v = top; v < std::min(top + kPatchCells, cells.part.bottom); ++v) {
        for (int u = left; u < std::min(left + kPatchCells, cells.part.right); ++u) {
          if (!cells.used[grid.Index(u, v)]) continue;
          ++n;
          const int off =
              std::abs(2 * (u - left) - kPatchCells) + std::abs(2 * (v - top) - kPatchCells);
          if (off < best) best = off, best_u = u, best_v = v;
        }
      }
      if (n < kFewestSeedCells) continue;
      const size_t i = grid.Index(best_u, best_v);
      seeds.push_back({static_cast<float>(best_u),
                       static_cast<float>(best_v),
                       cells.inverse_depth[i],
                       {cells.normal_x[i], cells.normal_y[i], cells.normal_z[i]}});
    }
  }
  return seeds;
}

/// Gives every used cell in reach of a seed to the seed that is nearest in place, plane and normal.
void Assign(const DepthGrid& grid, const SurfaceCells& cells, const InverseDepthNoise& noise,
            const std::vector<Seed>& seeds, std::vector<float>& distance, std::vector<int>& owner) {
  for (size_t i = 0; i < distance.size(); ++i) distance[i] = cells.used[i] ? 1e30f : -1.0f;
  std::fill(owner.begin(), owner.end(), SurfacePatches::kNone);
  constexpr float kPlace = 1.0f / (kPatchCells * kPatchCells);
  for (size_t s = 0; s < seeds.size(); ++s) {
    const Seed& seed = seeds[s];
    const int u0 = std::max(cells.part.left, static_cast<int>(seed.u) - kPatchCells);
    const int u1 = std::min(cells.part.right, static_cast<int>(seed.u) + kPatchCells + 1);
    const int v0 = std::max(cells.part.top, static_cast<int>(seed.v) - kPatchCells);
    const int v1 = std::min(cells.part.bottom, static_cast<int>(seed.v) + kPatchCells + 1);
    const Eigen::Vector3f ray = grid.Ray(seed.u, seed.v);
    const float facing = std::min(-0.05f, seed.normal.dot(ray));
    const Eigen::Vector3f slope = seed.normal * (seed.w / facing);
    const float step = slope.x() / grid.fx;
    const float sigma = noise(seed.w), per_sigma = 1 / sigma;
    const float nx = seed.normal.x(), ny = seed.normal.y(), nz = seed.normal.z();
    for (int v = v0; v < v1; ++v) {
      const size_t row = grid.Index(u0, v);
      const float w0 = slope.dot(grid.Ray(static_cast<float>(u0), static_cast<float>(v)));
      const float dv = static_cast<float>(v) - seed.v;
      const float* w = &cells.inverse_depth[row];
      const float *x = &cells.normal_x[row], *y = &cells.normal_y[row], *z = &cells.normal_z[row];
      float* __restrict best = &distance[row];
      int* __restrict own = &owner[row];
      for (int k = 0; k < u1 - u0; ++k) {
        const float du = static_cast<float>(u0 + k) - seed.u;
        const float off = (w[k] - w0 - step * static_cast<float>(k)) * per_sigma;
        const float turned = 2 - 2 * (nx * x[k] + ny * y[k] + nz * z[k]);
        const float d =
            kPlace * (du * du + dv * dv) + kNormalWeight * turned + kPlaneWeight * off * off;
        const bool mine = (d < best[k]) & (std::abs(off) < kOffPlane);
        best[k] = mine ? d : best[k];
        own[k] = mine ? static_cast<int>(s) : own[k];
      }
    }
  }
}

/// Moves the seeds to the means of their cells.
void MoveSeeds(const DepthGrid& grid, const SurfaceCells& cells, const std::vector<int>& owner,
               std::vector<Seed>& seeds) {
  std::vector<Seed> sums(seeds.size(), Seed{0, 0, 0, Eigen::Vector3f::Zero()});
  std::vector<float> count(seeds.size(), 0);
  for (int v = cells.part.top; v < cells.part.bottom; ++v) {
    for (int u = cells.part.left; u < cells.part.right; ++u) {
      const size_t i = grid.Index(u, v);
      const int s = owner[i];
      if (s < 0) continue;
      sums[s].u += static_cast<float>(u);
      sums[s].v += static_cast<float>(v);
      sums[s].w += cells.inverse_depth[i];
      sums[s].normal += Eigen::Vector3f(cells.normal_x[i], cells.normal_y[i], cells.normal_z[i]);
      count[s] += 1;
    }
  }
  for (size_t s = 0; s < seeds.size(); ++s) {
    if (count[s] == 0) continue;
    const float norm = sums[s].normal.norm();
    seeds[s] = {sums[s].u / count[s], sums[s].v / count[s], sums[s].w / count[s],
                norm > 0 ? Eigen::Vector3f(sums[s].normal / norm) : seeds[s].normal};
  }
}

/// Numbers the connected pieces of equal owners anew; pieces of too few cells get none. Returns how
/// many there are.
int SplitPieces(const DepthGrid& grid, const CellRectangle& part, std::vector<int>& owner) {
  std::vector<int> piece(owner.size(), SurfacePatches::kNone);
  std::vector<uint32_t> open, members;
  int n_pieces = 0;
  for (int v = part.top; v < part.bottom; ++v) {
    for (int u = part.left; u < part.right; ++u) {
      const auto start = static_cast<uint32_t>(grid.Index(u, v));
      if (owner[start] < 0 || piece[start] != SurfacePatches::kNone) continue;
      open.assign(1, start);
      members.clear();
      piece[start] = n_pieces;
      while (!open.empty()) {
        const uint32_t i = open.back();
        open.pop_back();
        members.push_back(i);
        const int x = static_cast<int>(i) % grid.width, y = static_cast<int>(i) / grid.width;
        auto visit = [&](bool inside, uint32_t j) {
          if (!inside || owner[j] != owner[i] || piece[j] != SurfacePatches::kNone) return;
          piece[j] = n_pieces;
          open.push_back(j);
        };
        visit(x > part.left, i - 1);
        visit(x + 1 < part.right, i + 1);
        visit(y > part.top, i - grid.width);
        visit(y + 1 < part.bottom, i + grid.width);
      }
      if (static_cast<int>(members.size()) >= kFewestCells) {
        ++n_pieces;
      } else {
        for (uint32_t i : members) piece[i] = -2;  // visited, but no patch
      }
    }
  }
  for (int& p : piece) p = std::max(p, SurfacePatches::kNone);
  owner.swap(piece);
  return n_pieces;
}

/// Sums of one patch's cells about its first one.
struct PatchSums {
  double n = 0, u = 0, v = 0, w = 0, uu = 0, uv = 0, vv = 0, uw = 0, vw = 0;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
};

/// The least-squares plane; where the cells lie on a line, that of their mean normal.
void FitPatch(const DepthGrid& grid, const PatchSums& s, const SensorNoise& sensor, Patch& patch) {
  const double u = s.u / s.n, v = s.v / s.n, w = s.w / s.n;
  const double uu = s.uu / s.n - u * u, vv = s.vv / s.n - v * v, uv = s.uv / s.n - u * v;
  const double uw = s.uw / s.n - u * w, vw = s.vw / s.n - v * w;
  const double det = uu * vv - uv * uv;
  patch.n_cells = static_cast<int>(s.n);
  patch.u = static_cast<float>(u);
  patch.v = static_cast<float>(v);
  const Eigen::Vector3f ray = grid.Ray(patch.u, patch.v);
  const double thin = 0.5 * (uu + vv) - std::sqrt(0.25 * (uu - vv) * (uu - vv) + uv * uv);
  if (thin > 0.4 && det > 0) {
    const double a = (uw * vv - vw * uv) / det * grid.fx, b = (vw * uu - uw * uv) / det * grid.fy;
    patch.slope = Eigen::Vector3d(a, b, w - a * ray.x() - b * ray.y()).cast<float>();
  } else {
    const Eigen::Vector3f normal = s.normal.normalized();
    patch.slope = normal * (static_cast<float>(w) / std::min(-0.05f, normal.dot(ray)));
  }
  patch.normal_C = -patch.slope.normalized();
  const double z = 1 / w;
  patch.centre_C = ray * static_cast<float>(z);
  const double facing = std::max(0.1f, std::abs(patch.normal_C.dot(ray.normalized())));
  patch.seen_m2 = static_cast<float>(s.n * z * z / (grid.fx * grid.fy));
  patch.area_m2 = static_cast<float>(patch.seen_m2 / facing);
  // Neighbouring readings err together: about one in four is independent.
  const double width_m = std::sqrt(std::max(thin, 0.1)) * z / grid.fx;
  patch.normal_sigma = static_cast<float>(sensor.Sigma(z) * facing * facing /
                                          (width_m * std::sqrt(std::max(1.0, s.n / 4))));
}

}  // namespace

void EstimateNormals(const DepthGrid& grid, const SensorNoise& sensor, SurfaceCells& cells) {
  const InverseDepthNoise noise(sensor);
  cells.normal_x.assign(grid.Size(), 0);
  cells.normal_y.assign(grid.Size(), 0);
  cells.normal_z.assign(grid.Size(), -1);
  const int left = std::max(2, cells.part.left), right = std::min(grid.width - 2, cells.part.right);
  const int top = std::max(2, cells.part.top),
            bottom = std::min(grid.height - 2, cells.part.bottom);
  for (int v = top; v < bottom; ++v) {
    const size_t row = grid.Index(0, v);
    const float y = (static_cast<float>(v) - grid.cy) / grid.fy;
    for (int u = left; u < right; ++u) {
      const float* w = &cells.inverse_depth[row + u];
      const float limit = 2.5f * noise(*w);
      const float a = SlopeAt(w, 1, limit) * grid.fx, b = SlopeAt(w, grid.width, limit) * grid.fy;
      const float x = (static_cast<float>(u) - grid.cx) / grid.fx;
      const float c = *w - a * x - b * y;
      const float scale = -1 / std::sqrt(a * a + b * b + c * c + 1e-20f);
      cells.normal_x[row + u] = a * scale;
      cells.normal_y[row + u] = b * scale;
      cells.normal_z[row + u] = c * scale;
    }
  }
}

SurfacePatches MakePatches(const DepthGrid& grid, const SurfaceCells& cells,
                           const SensorNoise& sensor) {
  SurfacePatches result;
  const InverseDepthNoise noise(sensor);
  std::vector<Seed> seeds = PlaceSeeds(grid, cells);
  std::vector<float> distance(grid.Size());
  result.patch_of_cell.resize(grid.Size());
  for (int i = 0; i < kIterations; ++i) {
    if (i > 0) MoveSeeds(grid, cells, result.patch_of_cell, seeds);
    Assign(grid, cells, noise, seeds, distance, result.patch_of_cell);
  }
  result.patches.resize(SplitPieces(grid, cells.part, result.patch_of_cell));
  std::vector<PatchSums> sums(result.patches.size());
  for (int v = cells.part.top; v < cells.part.bottom; ++v) {
    for (int u = cells.part.left; u < cells.part.right; ++u) {
      const size_t i = grid.Index(u, v);
      const int k = result.patch_of_cell[i];
      if (k < 0) continue;
      PatchSums& s = sums[k];
      const double x = u, y = v, w = grid.inverse_depth[i];
      s.n += 1, s.u += x, s.v += y, s.w += w;
      s.uu += x * x, s.uv += x * y, s.vv += y * y, s.uw += x * w, s.vw += y * w;
      s.normal += Eigen::Vector3f(cells.normal_x[i], cells.normal_y[i], cells.normal_z[i]);
    }
  }
  for (size_t k = 0; k < sums.size(); ++k) FitPatch(grid, sums[k], sensor, result.patches[k]);
  return result;
}

}  // namespace beckon::perception
