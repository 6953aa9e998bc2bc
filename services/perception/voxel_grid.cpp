// One pass over the pixels with a hash table of voxels.
#include "services/perception/voxel_grid.h"

#include <cmath>

namespace beckon::perception {
namespace {

/// Open addressing from a voxel's key to its index; keys are never removed.
class VoxelTable {
 public:
  VoxelTable() : slots_(1 << 17) {}

  /// The index of `key`, or the next free one after having taken it in.
  uint32_t FindOrAdd(uint64_t key) {
    Slot& slot = Find(key);
    if (slot.index != VoxelGrid::kNone) return slot.index;
    slot = {key, size_};
    if (2 * ++size_ > slots_.size()) Grow();
    return size_ - 1;
  }

 private:
  struct Slot {
    uint64_t key = 0;
    uint32_t index = VoxelGrid::kNone;
  };

  /// The slot of `key`, or the empty one where it belongs.
  Slot& Find(uint64_t key) {
    for (uint64_t at = (key * 0x9E3779B97F4A7C15ull) >> 20;; ++at) {
      Slot& slot = slots_[at & (slots_.size() - 1)];  // the size is a power of two
      if (slot.index == VoxelGrid::kNone || slot.key == key) return slot;
    }
  }

  void Grow() {
    std::vector<Slot> old(slots_.size() * 2);
    old.swap(slots_);
    for (const Slot& slot : old) {
      if (slot.index != VoxelGrid::kNone) Find(slot.key) = slot;
    }
  }

  std::vector<Slot> slots_;
  uint32_t size_ = 0;
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
  VoxelTable table;
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
        voxel = table.FindOrAdd(key);
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
