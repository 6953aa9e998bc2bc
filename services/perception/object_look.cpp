// One pass over the labels; colours are shared out among neighbouring cells, so that noise does not
// make them jump.
#include "services/perception/object_look.h"

#include <algorithm>
#include <cmath>

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
  for (int i = 0; i < 8; ++i) {
    const int ri = i >> 2, gi = i >> 1 & 1, bi = i & 1;
    colours[(r.cell + ri) * 16 + (g.cell + gi) * 4 + b.cell + bi] +=
        (ri != 0 ? r.upper : 1 - r.upper) * (gi != 0 ? g.upper : 1 - g.upper) *
        (bi != 0 ? b.upper : 1 - b.upper);
  }
}

}  // namespace

std::vector<ObjectLook> LookAt(const RgbdImage& image, std::span<const uint16_t> labels,
                               int n_labels) {
  std::vector<ObjectLook> looks(n_labels);
  std::vector<int> n_samples(n_labels, 0);
  std::vector<double> depth_squares(n_labels, 0);
  for (int v = 0; v < image.height; ++v) {
    const auto row = labels.subspan(image.Index(0, v), image.width);
    const auto first = std::find_if(row.begin(), row.end(), [](uint16_t k) { return k != 0; });
    for (int u = static_cast<int>(first - row.begin()); u < image.width; ++u) {
      const size_t i = image.Index(u, v);
      if (labels[i] == 0 || labels[i] > n_labels) continue;
      const int k = labels[i] - 1;
      ++looks[k].n_pixels;
      if (((u | v) & 1) != 0 || !(image.depth_m[i] > 0)) continue;
      ++n_samples[k];
      looks[k].centroid_C += image.Point(u, v);
      depth_squares[k] += static_cast<double>(image.depth_m[i]) * image.depth_m[i];
      if (!image.colour.empty()) AddColour(image.colour[i], looks[k].colours);
    }
  }
  for (int k = 0; k < n_labels; ++k) {
    if (n_samples[k] == 0) continue;
    looks[k].centroid_C /= n_samples[k];
    looks[k].area_m2 = looks[k].n_pixels * depth_squares[k] / n_samples[k] /
                       (image.intrinsics.fx * image.intrinsics.fy);
    if (image.colour.empty()) continue;
    for (float& share : looks[k].colours) share /= static_cast<float>(n_samples[k]);
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
