// A few points that stand for many.
#include "services/pose/even_spread.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

namespace beckon::pose {
namespace {

constexpr size_t kTableSize = 8192;  // of the hash table; a power of two
constexpr size_t kMostVoxels = kTableSize / 2;

struct Voxel {
  std::array<int64_t, 3> at;
  Eigen::Vector3d sum;
  int count;
};

// The occupied voxels, in the order of their first points; none where there are too many.
class VoxelTable {
 public:
  std::optional<std::vector<Voxel>> Fill(std::span<const Eigen::Vector3d> points, size_t step,
                                         double voxel_m) {
    slots_.fill(-1);
    std::vector<Voxel> voxels;
    voxels.reserve(1024);
    const double by_voxel = 1 / voxel_m;
    for (size_t i = 0; i < points.size(); i += step) {
      const Eigen::Vector3d& p = points[i];
      const std::array<int64_t, 3> at{Floor(p.x() * by_voxel), Floor(p.y() * by_voxel),
                                      Floor(p.z() * by_voxel)};
      size_t slot = Hash(at);
      while (slots_[slot] >= 0 && voxels[static_cast<size_t>(slots_[slot])].at != at) {
        slot = (slot + 1) % kTableSize;
      }
      if (slots_[slot] < 0) {
        if (voxels.size() == kMostVoxels) return std::nullopt;
        slots_[slot] = static_cast<int32_t>(voxels.size());
        voxels.push_back({at, p, 1});
      } else {
        Voxel& voxel = voxels[static_cast<size_t>(slots_[slot])];
        voxel.sum += p;
        ++voxel.count;
      }
    }
    return voxels;
  }

 private:
  static int64_t Floor(double x) {
    const auto i = static_cast<int64_t>(x);
    return i - (x < static_cast<double>(i) ? 1 : 0);
  }
  static size_t Hash(const std::array<int64_t, 3>& at) {
    const auto mix = [](int64_t i, uint64_t prime) { return static_cast<uint64_t>(i) * prime; };
    const uint64_t h = mix(at[0], 0x9E3779B97F4A7C15u) ^ mix(at[1], 0xC2B2AE3D27D4EB4Fu) ^
                       mix(at[2], 0x165667B19E3779F9u);
    return static_cast<size_t>((h >> 40) ^ (h >> 20)) % kTableSize;
  }

  std::array<int32_t, kTableSize> slots_;
};

double LongestExtent(std::span<const Eigen::Vector3d> points, size_t step) {
  Eigen::Vector3d lo = points[0], hi = points[0];
  for (size_t i = 0; i < points.size(); i += step) {
    lo = lo.cwiseMin(points[i]);
    hi = hi.cwiseMax(points[i]);
  }
  return (hi - lo).maxCoeff();
}

}  // namespace

SpreadPoints SpreadEvenly(std::span<const Eigen::Vector3d> points, int count) {
  SpreadPoints spread;
  const size_t most = static_cast<size_t>(std::max(count, 1));
  if (points.size() <= most) {
    spread.points.assign(points.begin(), points.end());
    spread.weights.assign(points.size(), 1);
    return spread;
  }
  // The grid's size is found on a part of the points.
  const size_t step = std::max<size_t>(points.size() / (4 * most), 1);
  double voxel_m =
      std::max(LongestExtent(points, step) / std::sqrt(static_cast<double>(most)), 1e-9);
  VoxelTable table;
  constexpr int kTries = 3;
  for (int tries = 0; tries < kTries; ++tries) {
    const auto voxels = table.Fill(points, step, voxel_m);
    const double ratio =
        voxels ? static_cast<double>(voxels->size()) / static_cast<double>(most) : 4;
    if (ratio > 0.8 && ratio < 1.25) break;
    voxel_m *= std::sqrt(ratio);  // points lie on a surface
  }
  auto voxels = table.Fill(points, 1, voxel_m);
  while (!voxels) voxels = table.Fill(points, 1, voxel_m *= 2);

  std::vector<int> counts;
  for (const Voxel& voxel : *voxels) counts.push_back(voxel.count);
  const auto middle = counts.begin() + static_cast<long>(counts.size() / 2);
  std::nth_element(counts.begin(), middle, counts.end());
  const double usual = 0.5 * *middle;
  for (const Voxel& voxel : *voxels) {
    spread.points.push_back(voxel.sum / voxel.count);
    spread.weights.push_back(std::min(voxel.count / usual, 1.0));
  }
  return spread;
}

}  // namespace beckon::pose
