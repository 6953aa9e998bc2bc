// One pass over the labels; colours are shared out among neighbouring cells, so that noise does not
// make them jump.
#include "services/perception/object_look.h"

#include <algorithm>
#include <cstring>

namespace beckon::perception {
namespace {

/// Where a channel lies among four cells, and how much of it belongs to the upper one of two.
struct Channel {
  int cell;
  float upper;
  explicit Channel(uint8_t value) {
    const float at = std::max(0.0f, static_cast<float>(value) / 64 - 0.5f);
    cell = std::min(2, static_cast<int>(at));
    upper = std::min(1.0f, at - static_cast<float>(cell));
  }
};

void AddColour(const Rgb& rgb, std::array<float, 64>& colours) {
  const Channel r(rgb[0]), g(rgb[1]), b(rgb[2]);
  float* const cell = &colours[r.cell * 16 + g.cell * 4 + b.cell];
  const float lower_b = 1 - b.upper;
  for (int i = 0; i < 4; ++i) {
    const int ri = i >> 1, gi = i & 1;
    const float of_two = (ri != 0 ? r.upper : 1 - r.upper) * (gi != 0 ? g.upper : 1 - g.upper);
    cell[ri * 16 + gi * 4] += of_two * lower_b;
    cell[ri * 16 + gi * 4 + 1] += of_two * b.upper;
  }
}

/// The first pixel from `u` on that has a label, else the row's width. Most have none, so that four
/// are looked at at once.
int NextLabel(std::span<const uint16_t> row, int u) {
  const int width = static_cast<int>(row.size());
  for (uint64_t four = 0; u + 4 <= width; u += 4) {
    std::memcpy(&four, &row[u], sizeof(four));
    if (four != 0) break;
  }
  while (u < width && row[u] == 0) ++u;
  return u;
}

/// Of the samples of an object. Points are linear in what is summed: one is unprojected for all.
struct Sums {
  int n = 0;
  double z = 0, uz = 0, vz = 0, zz = 0;

  void Add(int u, int v, double depth_m) {
    ++n;
    z += depth_m;
    uz += u * depth_m;
    vz += v * depth_m;
    zz += depth_m * depth_m;
  }
};

void Average(const RgbdImage& image, const Sums& sums, ObjectLook& look) {
  const Intrinsics& camera = image.intrinsics;
  look.centroid_C = {(sums.uz - camera.cx * sums.z) / camera.fx / sums.n,
                     (sums.vz - camera.cy * sums.z) / camera.fy / sums.n, sums.z / sums.n};
  look.area_m2 = look.n_pixels * sums.zz / sums.n / (camera.fx * camera.fy);
  if (image.colour.empty()) return;
  for (float& share : look.colours) share /= static_cast<float>(sums.n);
}

}  // namespace

std::vector<ObjectLook> LookAt(const RgbdImage& image, std::span<const uint16_t> labels,
                               int n_labels) {
  std::vector<ObjectLook> looks(n_labels);
  std::vector<Sums> sums(n_labels);
  for (int v = 0; v < image.height; ++v) {
    const auto row = labels.subspan(image.Index(0, v), image.width);
    for (int u = NextLabel(row, 0); u < image.width; u = NextLabel(row, u + 1)) {
      if (row[u] > n_labels) continue;
      const int k = row[u] - 1;
      ++looks[k].n_pixels;
      if (((u | v) & 1) != 0) continue;
      const size_t i = image.Index(u, v);
      if (!(image.depth_m[i] > 0)) continue;
      sums[k].Add(u, v, image.depth_m[i]);
      if (!image.colour.empty()) AddColour(image.colour[i], looks[k].colours);
    }
  }
  for (int k = 0; k < n_labels; ++k) {
    if (sums[k].n > 0) Average(image, sums[k], looks[k]);
  }
  return looks;
}

double Likeness(const ObjectLook& a, const ObjectLook& b) {
  float common = 0, in_a = 0, in_b = 0;
  for (size_t i = 0; i < a.colours.size(); ++i) {
    common += std::min(a.colours[i], b.colours[i]);
    in_a += a.colours[i];
    in_b += b.colours[i];
  }
  return in_a == 0 || in_b == 0 ? 1 : common;
}

}  // namespace beckon::perception
