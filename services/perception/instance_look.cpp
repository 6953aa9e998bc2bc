// Measures a view in a frame that stands on the table.
#include "services/perception/instance_look.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "services/perception/categoriser.h"

namespace beckon::perception {
namespace {

constexpr double kPitch_rad = 38 * std::numbers::pi / 180;  // of a camera whose table is not known
constexpr double kOutermost = 0.02;                         // part of the points, at either end
constexpr double kSmallest_m = 0.005;                       // sizes below are as this
constexpr size_t kEnough = 2000;                            // points, of more some are left out
constexpr int kTurns = 12;                                  // directions along the table

// What two views of one thing commonly differ by (beckon-bench-told; docs/model.md).
constexpr double kHeightScale = 0.05;  // of the logarithm
constexpr double kWidthScale = 0.20;   // of the logarithm
constexpr double kColourScale = 0.20;  // of 1 - what the histograms share

/// The part of `values` at `share`, 0 .. 1.
double Quantile(std::vector<double>& values, double share) {
  const auto at =
      values.begin() + static_cast<long>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double Span(std::vector<double> values) {
  const double low = Quantile(values, kOutermost);
  return Quantile(values, 1 - kOutermost) - low;
}

/// Shared out among neighbouring cells, so that noise does not make them jump.
void AddColour(const Rgb& rgb, std::array<float, InstanceLook::kCells>& cells) {
  int cell[3];
  float upper[3];
  for (int c = 0; c < 3; ++c) {
    const float at = std::clamp(static_cast<float>(rgb[c]) / 64 - 0.5f, 0.0f, 3.0f);
    cell[c] = std::min(2, static_cast<int>(at));
    upper[c] = at - static_cast<float>(cell[c]);
  }
  for (int i = 0; i < 8; ++i) {
    float share = 1;
    int index = 0;
    for (int c = 0; c < 3; ++c) {
      const int up = i >> c & 1;
      share *= up != 0 ? upper[c] : 1 - upper[c];
      index = index * 4 + cell[c] + up;
    }
    cells[index] += share;
  }
}

/// What the histograms share, 0 .. 1; 1 where either has no colour.
double Shared(const InstanceLook& a, const InstanceLook& b) {
  double in_a = 0, in_b = 0, common = 0;
  for (int i = 0; i < InstanceLook::kCells; ++i) {
    in_a += a.colours[i];
    in_b += b.colours[i];
    common += std::min(a.colours[i], b.colours[i]);
  }
  return in_a == 0 || in_b == 0 ? 1 : common;
}

double LogRatio(double a_m, double b_m) {
  return std::abs(std::log(std::max(a_m, kSmallest_m) / std::max(b_m, kSmallest_m)));
}

}  // namespace

InstanceLook LookAtInstance(const ObjectView& view) {
  const Eigen::Vector3d up = view.table_C
                                 ? view.table_C->normal.normalized()
                                 : Eigen::Vector3d(0, -std::cos(kPitch_rad), -std::sin(kPitch_rad));
  const Eigen::Vector3d right = up.unitOrthogonal(), ahead = up.cross(right);
  InstanceLook look;
  std::vector<Eigen::Vector2d> along;
  std::vector<double> heights;
  std::vector<size_t> seen;
  const RgbdImage& image = view.image;
  const size_t stride = 1 + view.pixels.size() / kEnough;
  for (size_t i = 0; i < view.pixels.size(); i += stride) {
    const uint32_t pixel = view.pixels[i];
    if (pixel >= image.depth_m.size() || !(image.depth_m[pixel] > 0)) continue;
    const int u = static_cast<int>(pixel) % image.width, v = static_cast<int>(pixel) / image.width;
    const Eigen::Vector3d p = image.Point(u, v);
    heights.push_back(p.dot(up));
    along.emplace_back(p.dot(right), p.dot(ahead));
    seen.push_back(pixel);
  }
  if (seen.size() < static_cast<size_t>(Categoriser::kMinPoints)) return look;
  look.n_points = static_cast<int>(seen.size());
  look.height_m = Span(std::move(heights));
  for (int turn = 0; turn < kTurns; ++turn) {
    const double angle = turn * std::numbers::pi / kTurns;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    std::vector<double> spread;
    for (const auto& p : along) spread.push_back(p.dot(direction));
    look.width_m = std::max(look.width_m, Span(std::move(spread)));
  }
  if (image.colour.empty()) return look;
  for (const size_t pixel : seen) AddColour(image.colour[pixel], look.colours);
  for (float& share : look.colours) share /= static_cast<float>(seen.size());
  return look;
}

double Difference(const InstanceLook& a, const InstanceLook& b) {
  if (a.n_points == 0 || b.n_points == 0) return std::numeric_limits<double>::infinity();
  return LogRatio(a.height_m, b.height_m) / kHeightScale +
         LogRatio(a.width_m, b.width_m) / kWidthScale + (1 - Shared(a, b)) / kColourScale;
}

}  // namespace beckon::perception
