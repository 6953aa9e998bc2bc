// RANSAC (Fischler and Bolles 1981) of the table around an object.
#include "services/perception/cue_up.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace beckon::perception {
namespace {

constexpr int kRounds = 150;
constexpr size_t kMostPoints = 1500;
constexpr size_t kFewestInliers = 120;
constexpr float kLeastShare = 0.25F;  // of the points around that lie on the table
constexpr float kFarthest_m = 0.35F;  // from the object's depth: what is farther is another surface
constexpr float kBelow_m = 0.012F;    // the object may reach this far below the plane
constexpr float kMostTurned = 0.45F;  // the camera is held upright: |x| of the normal
constexpr float kFacing = 0.15F;      // and looks down on the table: -y or -z of the normal

struct Points {
  std::vector<Eigen::Vector3f> object;
  std::vector<Eigen::Vector3f> around;
};

template <typename T>
void ThinTo(std::vector<T>& all, size_t most) {
  if (all.size() <= most) return;
  for (size_t i = 0; i < most; ++i) all[i] = all[i * all.size() / most];
  all.resize(most);
}

Points Collect(const ObjectView& view) {
  const RgbdImage& image = view.image;
  std::vector<uint8_t> mask(image.depth_m.size(), 0);
  Points points;
  std::vector<float> depths;
  for (const uint32_t pixel : view.pixels) {
    if (pixel >= mask.size()) continue;
    mask[pixel] = 1;
    if (image.depth_m[pixel] <= 0) continue;
    depths.push_back(image.depth_m[pixel]);
  }
  if (depths.empty()) return points;
  const auto middle = depths.begin() + static_cast<int64_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  for (size_t i = 0; i < mask.size(); ++i) {
    const float z = image.depth_m[i];
    if (z <= 0 || (mask[i] == 0 && std::abs(z - *middle) > kFarthest_m)) continue;
    const int u = static_cast<int>(i) % image.width, v = static_cast<int>(i) / image.width;
    (mask[i] != 0 ? points.object : points.around).push_back(image.Point(u, v).cast<float>());
  }
  ThinTo(points.object, 400);
  ThinTo(points.around, kMostPoints);
  return points;
}

float Tolerance(const Eigen::Vector3f& p) { return 0.003F + 0.003F * p.z() * p.z(); }

struct TablePlane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float offset = 0;  // normal . p + offset = 0

  float Distance(const Eigen::Vector3f& p) const { return normal.dot(p) + offset; }
};

TablePlane Through(const Eigen::Vector3f& point, Eigen::Vector3f normal) {
  if (normal.dot(point) > 0) normal = -normal;  // towards the camera
  return {normal, -normal.dot(point)};
}

bool MayBeTable(const TablePlane& plane, const std::vector<Eigen::Vector3f>& object) {
  const Eigen::Vector3f& n = plane.normal;
  if (std::abs(n.x()) > kMostTurned || -n.y() < kFacing || n.y() + n.z() > -0.6F) return false;
  const auto below = std::count_if(object.begin(), object.end(), [&](const Eigen::Vector3f& p) {
    return plane.Distance(p) < -kBelow_m;
  });
  return below * 20 <= static_cast<int64_t>(object.size());
}

std::vector<Eigen::Vector3f> Inliers(const TablePlane& plane,
                                     const std::vector<Eigen::Vector3f>& points) {
  std::vector<Eigen::Vector3f> inliers;
  for (const auto& p : points) {
    if (std::abs(plane.Distance(p)) < Tolerance(p)) inliers.push_back(p);
  }
  return inliers;
}

TablePlane Fit(const std::vector<Eigen::Vector3f>& points) {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (const auto& p : points) mean += p;
  mean /= static_cast<float>(points.size());
  Eigen::Matrix3f scatter = Eigen::Matrix3f::Zero();
  for (const auto& p : points) scatter += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver(scatter);
  return Through(mean, solver.eigenvectors().col(0));
}

}  // namespace

std::optional<Eigen::Vector3f> EstimateUp(const ObjectView& view) {
  const Points points = Collect(view);
  if (points.around.size() < kFewestInliers) return std::nullopt;
  std::mt19937 random(1);
  const auto draw = [&]() -> const Eigen::Vector3f& {
    return points.around[random() % points.around.size()];
  };
  TablePlane best;
  size_t most = 0;
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::Vector3f &a = draw(), &b = draw(), &c = draw();
    const Eigen::Vector3f normal = (b - a).cross(c - a);
    if (!(normal.norm() > 1e-5F)) continue;
    const TablePlane plane = Through(a, normal.normalized());
    if (!MayBeTable(plane, points.object)) continue;
    const auto count = static_cast<size_t>(
        std::count_if(points.around.begin(), points.around.end(),
                      [&](const auto& p) { return std::abs(plane.Distance(p)) < Tolerance(p); }));
    if (count > most) best = plane, most = count;
  }
  const auto enough = std::max(
      kFewestInliers, static_cast<size_t>(kLeastShare * static_cast<float>(points.around.size())));
  if (most < enough) return std::nullopt;
  best = Fit(Inliers(best, points.around));
  if (!best.normal.allFinite() || !MayBeTable(best, points.object)) return std::nullopt;
  return best.normal;
}

}  // namespace beckon::perception
