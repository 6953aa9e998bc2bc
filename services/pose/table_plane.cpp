// The table under labelled objects, where nobody says which plane it is.
#include "services/pose/table_plane.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "services/base/rim.h"

namespace beckon::pose {
namespace {

constexpr int kAround_px = 60;        // how far from an object's pixels the table is looked for,
constexpr float kAround_m = 0.15f;    // and how much nearer or farther than them
constexpr size_t kMostPoints = 3000;  // that hypotheses are judged by
constexpr int kHypotheses = 300;
constexpr size_t kFewestInliers = 200;
constexpr double kSmallestShare = 0.25;  // of the points, on the table
constexpr double kLargestBelow = 0.05;   // of the objects' points, below the table
constexpr unsigned kSeed = 1;

using Points = std::vector<Eigen::Vector3d>;

/// Box around an object in the image and in depth.
struct Surroundings {
  int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;
  float near_m = 1e9f, far_m = 0;
};

std::vector<Surroundings> SurroundingsOf(const RgbdImage& image, std::span<const uint16_t> labels) {
  std::vector<Surroundings> boxes;
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const size_t i = image.Index(u, v);
      if (labels[i] == 0 || !(image.depth_m[i] > 0)) continue;
      if (labels[i] >= boxes.size()) boxes.resize(labels[i] + 1u);
      Surroundings& box = boxes[labels[i]];
      box.left = std::min(box.left, u - kAround_px);
      box.right = std::max(box.right, u + kAround_px);
      box.top = std::min(box.top, v - kAround_px);
      box.bottom = std::max(box.bottom, v + kAround_px);
      box.near_m = std::min(box.near_m, image.depth_m[i] - kAround_m);
      box.far_m = std::max(box.far_m, image.depth_m[i] + kAround_m);
    }
  }
  std::erase_if(boxes, [](const Surroundings& box) { return box.right < 0; });
  return boxes;
}

/// At most about kMostPoints, evenly spread.
Points Thin(const Points& points) {
  const size_t stride = points.size() / kMostPoints + 1;
  Points kept;
  for (size_t i = 0; i < points.size(); i += stride) kept.push_back(points[i]);
  return kept;
}

/// Unlabelled points close to an object.
Points PointsAround(const RgbdImage& image, std::span<const uint16_t> labels) {
  std::vector<bool> taken(labels.size(), false);
  Points points;
  for (const Surroundings& box : SurroundingsOf(image, labels)) {
    for (int v = std::max(box.top, 0); v <= std::min(box.bottom, image.height - 1); ++v) {
      for (int u = std::max(box.left, 0); u <= std::min(box.right, image.width - 1); ++u) {
        const size_t i = image.Index(u, v);
        const float z = image.depth_m[i];
        if (labels[i] != 0 || taken[i] || !(z > 0) || z < box.near_m || z > box.far_m) continue;
        taken[i] = true;
        points.push_back(image.Point(u, v));
      }
    }
  }
  return Thin(points);
}

Points PointsOfObjects(const RgbdImage& image, std::span<const uint16_t> labels) {
  Points points;
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const size_t i = image.Index(u, v);
      if (labels[i] != 0 && image.depth_m[i] > 0) points.push_back(image.Point(u, v));
    }
  }
  return Thin(points);
}

double Tolerance(const Eigen::Vector3d& p) { return ClearStep(static_cast<float>(p.z())); }

Points Inliers(const Plane& plane, const Points& points) {
  Points inliers;
  for (const auto& p : points) {
    if (std::abs(plane.Distance(p)) < Tolerance(p)) inliers.push_back(p);
  }
  return inliers;
}

Plane TowardsCamera(const Eigen::Vector3d& normal, const Eigen::Vector3d& through) {
  const Plane plane{normal, -normal.dot(through)};
  return plane.offset_m < 0 ? Plane{-normal, -plane.offset_m} : plane;
}

bool CutsObjects(const Plane& plane, const Points& objects) {
  const auto below = std::count_if(objects.begin(), objects.end(), [&](const auto& p) {
    return plane.Distance(p) < -Tolerance(p);
  });
  return static_cast<double>(below) > kLargestBelow * static_cast<double>(objects.size());
}

Plane LeastSquares(const Points& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& p : points) scatter += (p - mean) * (p - mean).transpose();
  return TowardsCamera(
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0), mean);
}

}  // namespace

Result<Plane> FindTablePlane(const RgbdImage& image, std::span<const uint16_t> labels) {
  const Points around = PointsAround(image, labels), objects = PointsOfObjects(image, labels);
  const Error none{"no table found around the labelled objects (" + std::to_string(around.size()) +
                   " unlabelled points near them); say where it is by --plane nx,ny,nz,d"};
  if (around.size() < kFewestInliers) return none;
  std::mt19937 engine(kSeed);
  const auto any = [&] { return around[engine() % around.size()]; };
  Points best;
  for (int i = 0; i < kHypotheses; ++i) {
    const Eigen::Vector3d a = any(), b = any(), c = any();
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    if (normal.norm() < 1e-6) continue;
    const Plane plane = TowardsCamera(normal.normalized(), a);
    Points inliers = Inliers(plane, around);
    if (inliers.size() > best.size() && !CutsObjects(plane, objects)) best = std::move(inliers);
  }
  const double share = static_cast<double>(best.size()) / static_cast<double>(around.size());
  if (best.size() < kFewestInliers || share < kSmallestShare) return none;
  Plane plane = LeastSquares(best);
  for (int i = 0; i < 3; ++i) {
    const Points inliers = Inliers(plane, around);
    if (inliers.size() < kFewestInliers) return none;
    plane = LeastSquares(inliers);
  }
  return plane;
}

}  // namespace beckon::pose
