// Depth images as they should not be, and what any segmentation of them must be.
#include "tests/perception/hostile_images.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/perception/box_world.h"

namespace beckon::perception {
namespace {

RgbdImage SoundImage(Draws& draws, int width) {
  static std::map<std::pair<int, size_t>, RgbdImage> rendered;
  const size_t kind = draws.Index(3);
  RgbdImage& image = rendered[{width, kind}];
  if (!image.depth_m.empty()) return image;
  BoxWorld world = ThreeBoxes();
  world.width = width;
  world.height = width * 3 / 4;
  world.noise_m = kind == 0 ? 0 : kKinectNoise_m;
  world.cups.push_back({{-0.05, 0.55}, 0.04, 0.09});
  if (kind == 2) {
    world.pitch_deg = 25;
    world.boxes.push_back({{-3, 1.3, -1}, {3, 1.4, 3}});
    world.boxes.push_back({{-3, -1, -0.75}, {3, 4, -0.72}});
  }
  return image = world.Render();
}

float AnyDepth(Draws& draws) {
  constexpr float kDepths[] = {0.5f, 2.9999f, 3.0001f, 0.3f, -1, 1e-30f, 65535};
  return draws.OneIn(2) ? draws.OddNumber() : draws.Any(kDepths);
}

struct Rectangle {
  int left, top, right, bottom;
};

Rectangle AnyRectangle(const RgbdImage& image, Draws& draws) {
  const int left = draws.Between(0, image.width - 1), top = draws.Between(0, image.height - 1);
  return {left, top, draws.Between(left + 1, image.width), draws.Between(top + 1, image.height)};
}

template <typename Change>
void ForEach(RgbdImage& image, const Rectangle& part, Change change) {
  for (int v = part.top; v < part.bottom; ++v) {
    for (int u = part.left; u < part.right; ++u) change(image.depth_m[image.Index(u, v)], u, v);
  }
}

void Fill(RgbdImage& image, Draws& draws) {
  const float depth_m = AnyDepth(draws);
  ForEach(image, AnyRectangle(image, draws), [&](float& d, int, int) { d = depth_m; });
}

void Roughen(RgbdImage& image, Draws& draws) {
  Draws more(draws());  // one choice, so that bytes are left for others
  const float most_m = draws.OneIn(2) ? 3 : 0.05f;
  ForEach(image, AnyRectangle(image, draws),
          [&](float& d, int, int) { d = more.OneIn(2) ? d + more.Uniform(0, most_m) : most_m; });
}

void Speckle(RgbdImage& image, Draws& draws) {
  Draws more(draws());
  for (size_t n = more.Index(image.depth_m.size()); n > 0; --n) {
    more.Any(image.depth_m) = AnyDepth(more);
  }
}

void Stripe(RgbdImage& image, Draws& draws) {
  const int period = draws.Between(1, 12), missing = draws.Between(0, period);
  const bool rows = draws.OneIn(2);
  const float depth_m = draws.OneIn(2) ? 0 : AnyDepth(draws);
  ForEach(image, AnyRectangle(image, draws), [&](float& d, int u, int v) {
    if ((rows ? v : u) % period < missing) d = depth_m;
  });
}

/// As where a transfer loses bytes.
void ShiftRows(RgbdImage& image, Draws& draws) {
  const auto by = static_cast<std::ptrdiff_t>(draws.Index(image.depth_m.size()));
  const auto from = static_cast<std::ptrdiff_t>(draws.Index(image.depth_m.size()));
  const auto begin = image.depth_m.begin();
  std::rotate(begin + from, begin + std::max(from, by), image.depth_m.end());
}

void Scale(RgbdImage& image, Draws& draws) {
  const float factor = std::exp(draws.Uniform(-4, 4));
  for (float& depth_m : image.depth_m) depth_m *= factor;
}

void TakeAnotherCamera(RgbdImage& image, Draws& draws) {
  const auto focal = [&] { return std::pow(10.0, draws.Between(2, 10) / 2.0); };
  const auto centre = [&] { return draws.OneIn(4) ? 1e5 : 1.0 * draws.Between(-700, 700); };
  image.intrinsics.fx = focal();
  image.intrinsics.fy = draws.OneIn(2) ? image.intrinsics.fx : focal();
  if (draws.OneIn(2)) return;
  image.intrinsics.cx = centre();
  image.intrinsics.cy = centre();
}

void Crop(RgbdImage& image, Draws& draws) {
  Rectangle part = AnyRectangle(image, draws);
  if (draws.OneIn(8)) part.right = part.left + 1;
  if (draws.OneIn(8)) part.bottom = part.top + 1;
  RgbdImage cropped{part.right - part.left, part.bottom - part.top, image.intrinsics, {}, {}};
  ForEach(image, part, [&](float& d, int u, int v) {
    cropped.depth_m.push_back(d);
    cropped.colour.push_back(image.colour[image.Index(u, v)]);
  });
  cropped.intrinsics.cx -= part.left;
  cropped.intrinsics.cy -= part.top;
  image = std::move(cropped);
}

}  // namespace

RgbdImage HostileImage(Draws& draws, int width) {
  constexpr void (*kDamages[])(RgbdImage&, Draws&) = {
      Fill, Fill, Roughen, Speckle, Stripe, ShiftRows, Scale, TakeAnotherCamera, Crop};
  RgbdImage image = SoundImage(draws, width);
  for (size_t n = draws.Index(5); n > 0; --n) draws.Any(kDamages)(image, draws);
  return image;
}

SegmentationConfig AnyConfig(Draws& draws) {
  SegmentationConfig config;
  if (draws.OneIn(2)) return config;
  const auto any = [&](double usual, double least, double most) {
    const double values[] = {usual, usual, usual, least, most};
    return draws.Any(values);
  };
  config.max_range_m = any(3, 1, 100);
  config.sensor.floor_m = any(0.0012, 0.00001, 0.1);
  config.sensor.growth_per_m = any(0.0019, 0, 0.1);
  config.sensor.from_m = any(0.4, 0, 10);
  config.min_object_m2 = any(0.0003, 0.000001, 1);
  config.plane_distance_m = any(0.01, 0.0005, 0.1);
  config.plane_min_points = static_cast<int>(any(2000, 3, 10'000));
  config.table_max_tilt_deg = any(80, 0, 180);
  config.table_gap_m = any(0.1, 0.01, 10);
  config.min_height_m = any(0.01, 0.0005, 0.4);
  config.max_height_m = any(0.5, 0.45, 3);
  config.border_m = any(0.03, 0, 1);
  config.max_objects = static_cast<int>(any(64, 1, 2));
  config.cluster_min_points = static_cast<int>(any(150, 1, 50));
  return config;
}

std::string Unsound(const RgbdImage& image, const SegmentationConfig& config,
                    const Segmentation& result) {
  if (result.labels.size() != image.depth_m.size()) return "not a label for each pixel";
  if (result.n_objects < 0 || result.n_objects > config.max_objects) return "too many objects";
  if (result.table_C.has_value() != result.reason.empty()) return "no reason, or one too many";
  std::vector<int> n_pixels(static_cast<size_t>(result.n_objects) + 1, 0);
  for (size_t i = 0; i < result.labels.size(); ++i) {
    const uint16_t label = result.labels[i];
    if (label > result.n_objects) return "a label without an object";
    ++n_pixels[label];
    const float depth_m = image.depth_m[i];
    if (label != 0 && !(std::isfinite(depth_m) && depth_m > 0)) return "an object without depth";
  }
  for (int k = 1; k <= result.n_objects; ++k) {
    if (n_pixels[k] == 0) return "an object without pixels";
    if (k > 1 && n_pixels[k] > n_pixels[k - 1]) return "a larger object after a smaller one";
  }
  if (!result.table_C) {
    return result.n_objects > 0 || !result.hull_C.empty() ? "objects on no table" : "";
  }
  const Plane& table_C = *result.table_C;
  if (!table_C.normal.allFinite() || !std::isfinite(table_C.offset_m)) return "a table nowhere";
  if (std::abs(table_C.normal.norm() - 1) > 1e-3) return "a normal that is not of length 1";
  if (table_C.offset_m < 0) return "a normal away from the camera";
  if (result.hull_C.size() < 3) return "a table without an outline";
  const auto is_finite = [](const Eigen::Vector3d& p) { return p.allFinite(); };
  return std::all_of(result.hull_C.begin(), result.hull_C.end(), is_finite)
             ? ""
             : "an outline without end";
}

bool Same(const Segmentation& a, const Segmentation& b) {
  return a.reason == b.reason && a.labels == b.labels && a.hull_C == b.hull_C &&
         a.n_objects == b.n_objects && a.table_C.has_value() == b.table_C.has_value() &&
         (!a.table_C ||
          (a.table_C->normal == b.table_C->normal && a.table_C->offset_m == b.table_C->offset_m));
}

}  // namespace beckon::perception
