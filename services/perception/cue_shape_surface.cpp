// Directions of normals, hollowness and convexity.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "services/perception/cue_shape_measures.h"

namespace beckon::perception {
namespace {

/// Appends a histogram of `values`, in shares.
template <size_t kBins>
void AppendHistogram(const std::vector<float>& values, float low, float high,
                     std::vector<float>& out) {
  std::array<float, kBins> shares{};
  for (const float value : values) {
    const float at = std::clamp((value - low) / (high - low), 0.0F, 0.999F);
    shares[static_cast<size_t>(at * kBins)] += 1;
  }
  for (float& share : shares) share /= std::max<float>(1, static_cast<float>(values.size()));
  out.insert(out.end(), shares.begin(), shares.end());
}

/// How the side's normals are spread around: a box has one or two directions, a cylinder all.
void MeasureAzimuths(const CueView& view, std::vector<float>& out) {
  constexpr int kSectors = 18;
  std::array<float, kSectors> sectors{};
  Eigen::Vector2f once(0, 0), twice(0, 0), four(0, 0);
  float count = 1e-3F;
  for (int i = 0; i < view.size(); ++i) {
    const Eigen::Vector3f n = view.normals_T.col(i);
    if (std::abs(n.z()) > 0.7F) continue;
    const float angle = std::atan2(n.y(), n.x());
    const float turn = angle / (2 * std::numbers::pi_v<float>)+0.5F;
    sectors[static_cast<size_t>(std::clamp(turn * kSectors, 0.0F, kSectors - 0.01F))] += 1;
    once += Eigen::Vector2f(std::cos(angle), std::sin(angle));
    twice += Eigen::Vector2f(std::cos(2 * angle), std::sin(2 * angle));
    four += Eigen::Vector2f(std::cos(4 * angle), std::sin(4 * angle));
    ++count;
  }
  std::sort(sectors.begin(), sectors.end(), std::greater<>());
  for (size_t i = 0; i < 8; ++i) out.push_back(sectors[i] / count);
  out.insert(out.end(), {once.norm() / count, twice.norm() / count, four.norm() / count,
                         count / static_cast<float>(view.size())});
}

/// Change of the normal along the line between two points, per length: > 0 where convex.
float Convexity(const CueView& view, int i, int j) {
  const Eigen::Vector3f d = view.points_T.col(j) - view.points_T.col(i);
  return (view.normals_T.col(j) - view.normals_T.col(i)).dot(d) / std::max(1e-4F, d.norm());
}

}  // namespace

void MeasureNormals(const CueView& view, const Revolution& body, std::vector<float>& out) {
  constexpr int kLevels = 6;
  std::vector<float> up;
  std::array<float, kLevels> sum{}, count{};
  float lid = 0, floor = 0;
  for (int i = 0; i < view.size(); ++i) {
    const float nz = view.normals_T(2, i);
    const float level = view.points_T(2, i) / std::max(1e-3F, body.height_m);
    up.push_back(nz);
    if (nz > 0.9F && level > 0.85F) ++lid;
    if (nz > 0.85F && level < 0.7F) ++floor;
    const auto bin = static_cast<size_t>(std::clamp(level * kLevels, 0.0F, kLevels - 0.01F));
    sum[bin] += nz;
    ++count[bin];
  }
  AppendHistogram<10>(up, -1, 1, out);
  for (size_t i = 0; i < kLevels; ++i) out.push_back(sum[i] / std::max(1.0F, count[i]));
  const float n = static_cast<float>(view.size());
  out.insert(out.end(), {lid / n, floor / n, lid * view.voxel_m * view.voxel_m});
  MeasureAzimuths(view, out);
}

void MeasureHollowness(const CueView& view, const Revolution& body, std::vector<float>& out) {
  std::vector<float> central, facing, facing_low, facing_high, levels;
  for (int i = 0; i < view.size(); ++i) {
    const float level = view.points_T(2, i) / std::max(1e-3F, body.height_m);
    levels.push_back(level);
    const auto radius = body.radii_m[static_cast<size_t>(i)];
    if (radius < 0.5F * body.max_radius_m) central.push_back(level);
    const Eigen::Vector2f n = view.normals_T.col(i).head<2>();
    if (n.norm() < 0.3F) continue;
    // -1: faces the axis, as the inside of a bowl does; 1: faces away from it
    const float outward =
        n.normalized().dot(view.points_T.col(i).head<2>() - body.axis_T) / std::max(1e-3F, radius);
    facing.push_back(outward);
    (level < 0.5F ? facing_low : facing_high).push_back(outward);
  }
  AppendHistogram<6>(facing, -1, 1, out);
  for (const auto* part : {&facing_low, &facing_high}) {
    const auto inward = std::count_if(part->begin(), part->end(), [](float f) { return f < 0; });
    out.push_back(static_cast<float>(inward) / static_cast<float>(view.size()));
  }
  for (const float q : {0.05F, 0.25F, 0.5F, 0.75F, 0.95F}) out.push_back(Quantile(central, q));
  out.push_back(static_cast<float>(central.size()) / static_cast<float>(view.size()));
  for (const float q : {0.25F, 0.5F, 0.75F}) out.push_back(Quantile(levels, q));

  std::vector<float> near, far, distances;
  for (int i = 0; i < view.size(); ++i) {
    for (uint32_t k = view.first[i]; k < view.first[i + 1]; k += 5) {
      if (view.squared_distances_m2[k] > 1.5e-4F) {
        near.push_back(Convexity(view, i, static_cast<int>(view.neighbours[k])));
      }
    }
    for (int step = 1; step < 12; ++step) {
      const int j = (i + step * 83) % view.size();
      far.push_back(Convexity(view, i, j));
      distances.push_back((view.points_T.col(i) - view.points_T.col(j)).norm());
    }
  }
  AppendHistogram<8>(near, -1, 1, out);
  AppendHistogram<8>(far, -1.5F, 1.5F, out);
  AppendHistogram<10>(distances, 0, 0.25F, out);
  const float scale = std::max(1e-3F, Quantile(distances, 0.95F));
  for (float& d : distances) d /= scale;
  AppendHistogram<8>(distances, 0, 1.2F, out);
}

}  // namespace beckon::perception
