// One pass over the pixels with a hash table of voxels.
#include "services/perception/voxel_grid.h"

#include <bit>
#include <cmath>

namespace beckon::perception {
namespace {

/// Open addressing from a voxel's key to its index; the keys are never removed.
class VoxelTable {
 public:
  explicit VoxelTable(size_t most)
      : slots_(std::bit_ceil(2 * most + 2)), mask_(slots_.size() - 1) {}

  /// The index of `key`, or `next` after having taken it in.
  uint32_t FindOrAdd(uint64_t key, uint32_t next) {
    uint64_t at = (key * 0x9E3779B97F4A7C15ull) >> 20;
    for (;; ++at) {
      Slot& slot = slots_[at & mask_];
      if (slot.index == VoxelGrid::kNone) {
        slot = {key, next};
        return next;
      }
      if (slot.key == key) return slot.index;
    }
  }

 private:
  struct Slot {
    uint64_t key = 0;
    uint32_t index = VoxelGrid::kNone;
  };
  std::vector<Slot> slots_;
  uint64_t mask_;
};

/// 21 bits a coordinate: at 0.5 mm that is 1 km across.
uint64_t Key(const Eigen::Vector3d& p_C, double per_m) {
  auto cell = [per_m](double x) {
    return static_cast<uint64_t>(static_cast<int64_t>(std::floor(x * per_m)) + (1 << 20)) &
           0x1fffff;
  };
  return cell(p_C.x()) | cell(p_C.y()) << 21 | cell(p_C.z()) << 42;
}

}  // namespace

VoxelGrid MakeVoxelGrid(const RgbdImage& image, double voxel_m, double min_range_m,
                        double max_range_m) {
  VoxelGrid grid;
  grid.voxel_of_pixel.assign(image.depth_m.size(), VoxelGrid::kNone);
  VoxelTable table(image.depth_m.size());
  std::vector<uint32_t> counts;
  std::vector<Eigen::Vector3d> sums;
  uint64_t last_key = ~0ull;
  uint32_t voxel = 0;
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const size_t pixel = image.Index(u, v);
      const float depth_m = image.depth_m[pixel];
      if (!(depth_m >= min_range_m && depth_m <= max_range_m)) continue;
      const Eigen::Vector3d p_C = image.Point(u, v);
      const uint64_t key = Key(p_C, 1 / voxel_m);
      if (key != last_key) {
        voxel = table.FindOrAdd(key, static_cast<uint32_t>(sums.size()));
        last_key = key;
        if (voxel == sums.size()) {
          sums.push_back(Eigen::Vector3d::Zero());
          counts.push_back(0);
        }
      }
      sums[voxel] += p_C;
      ++counts[voxel];
      grid.voxel_of_pixel[pixel] = voxel;
      ++grid.n_pixels;
    }
  }
  grid.points_C.reserve(sums.size());
  for (size_t i = 0; i < sums.size(); ++i) {
    grid.points_C.push_back((sums[i] / counts[i]).cast<float>());
  }
  return grid;
}

}  // namespace beckon::perception
