#include "services/base/rgbd.h"

#include <cmath>
#include <string>

namespace beckon {
namespace {

constexpr int kFewestPoints = 100;
constexpr double kLargestResidual_px = 1.0;

/// Least squares of ratio = slope * pixel + offset, from running sums.
struct LineFit {
  double n = 0, p = 0, pp = 0, r = 0, pr = 0, rr = 0;

  void Add(double pixel, double ratio) {
    n += 1;
    p += pixel;
    pp += pixel * pixel;
    r += ratio;
    pr += pixel * ratio;
    rr += ratio * ratio;
  }

  /// Focal length 1 / slope, principal point -offset / slope, and the residual in pixels.
  bool Solve(double& focal_px, double& centre_px, double& residual_px) const {
    const double spread = n * pp - p * p;
    if (!(spread > 0.25 * n * n)) return false;  // less than half a pixel of spread
    const double slope = (n * pr - p * r) / spread;
    const double offset = (r - slope * p) / n;
    if (!(slope > 0)) return false;
    focal_px = 1.0 / slope;
    centre_px = -offset / slope;
    const double squares = rr - slope * pr - offset * r;
    residual_px = std::sqrt(std::max(0.0, squares / n)) * focal_px;
    return true;
  }
};

bool InFront(const Eigen::Vector3f& p) { return p.allFinite() && p.z() > 0; }

/// Whether the cloud has as many of everything as its width and height say.
bool Consistent(const Cloud& cloud) {
  const size_t n = cloud.points.size();
  return cloud.width >= 0 && cloud.height >= 0 &&
         n == static_cast<size_t>(cloud.width) * static_cast<size_t>(cloud.height) &&
         (cloud.colours.empty() || cloud.colours.size() == n) &&
         (cloud.labels.empty() || cloud.labels.size() == n);
}

RgbdImage Blank(int width, int height, const Intrinsics& intrinsics, const Cloud& cloud,
                std::vector<uint32_t>* labels) {
  RgbdImage image;
  image.width = width;
  image.height = height;
  image.intrinsics = intrinsics;
  const size_t n = static_cast<size_t>(width) * static_cast<size_t>(height);
  image.depth_m.assign(n, 0.0f);
  if (!cloud.colours.empty()) image.colour.assign(n, Rgb{});
  if (labels != nullptr) labels->assign(n, 0);
  return image;
}

RgbdImage KeepGrid(const Cloud& cloud, const Intrinsics& intrinsics,
                   std::vector<uint32_t>* labels) {
  RgbdImage image = Blank(cloud.width, cloud.height, intrinsics, cloud, labels);
  for (size_t i = 0; i < cloud.points.size(); ++i) {
    if (InFront(cloud.points[i])) image.depth_m[i] = cloud.points[i].z();
  }
  image.colour = cloud.colours;
  if (labels != nullptr && !cloud.labels.empty()) *labels = cloud.labels;
  return image;
}

RgbdImage ProjectPoints(const Cloud& cloud, const Intrinsics& intrinsics,
                        std::vector<uint32_t>* labels) {
  RgbdImage image = Blank(640, 480, intrinsics, cloud, labels);
  for (size_t i = 0; i < cloud.points.size(); ++i) {
    if (!InFront(cloud.points[i])) continue;
    const Eigen::Vector2d pixel = intrinsics.Project(cloud.points[i].cast<double>());
    const double u = std::round(pixel.x());
    const double v = std::round(pixel.y());
    if (!(u >= 0 && u < image.width && v >= 0 && v < image.height)) continue;
    const size_t at = image.Index(static_cast<int>(u), static_cast<int>(v));
    if (image.depth_m[at] > 0 && image.depth_m[at] <= cloud.points[i].z()) continue;
    image.depth_m[at] = cloud.points[i].z();
    if (!cloud.colours.empty()) image.colour[at] = cloud.colours[i];
    if (labels != nullptr && !cloud.labels.empty()) (*labels)[at] = cloud.labels[i];
  }
  return image;
}

}  // namespace

Result<Intrinsics> EstimateIntrinsics(const Cloud& organised) {
  if (!organised.organised() || !Consistent(organised)) {
    return Error{"intrinsics: expected an organised cloud"};
  }
  LineFit horizontal, vertical;
  for (int v = 0; v < organised.height; ++v) {
    for (int u = 0; u < organised.width; ++u) {
      const auto& p = organised.points[static_cast<size_t>(v) * organised.width + u];
      if (!InFront(p)) continue;
      horizontal.Add(u, static_cast<double>(p.x()) / p.z());
      vertical.Add(v, static_cast<double>(p.y()) / p.z());
    }
  }
  if (horizontal.n < kFewestPoints) {
    return Error{"intrinsics: expected at least 100 points with depth, found " +
                 std::to_string(static_cast<int>(horizontal.n))};
  }
  Intrinsics found;
  double residual_u = 0, residual_v = 0;
  if (!horizontal.Solve(found.fx, found.cx, residual_u) ||
      !vertical.Solve(found.fy, found.cy, residual_v) || !Validate(found) ||
      !(residual_u < kLargestResidual_px && residual_v < kLargestResidual_px)) {
    return Error{"intrinsics: the points do not lie on the rays of a pinhole camera's pixels"};
  }
  return found;
}

Result<RgbdImage> ToImage(const Cloud& cloud, const Intrinsics* intrinsics,
                          std::vector<uint32_t>* labels) {
  if (!Consistent(cloud)) return Error{"cloud: its width and height do not match its points"};
  if (intrinsics != nullptr) {
    if (auto status = Validate(*intrinsics); !status) return status.error();
  }
  constexpr int kLargestImage = 4096;
  RgbdImage image;
  const bool grid =
      cloud.organised() && cloud.width <= kLargestImage && cloud.height <= kLargestImage;
  const auto estimated = grid ? EstimateIntrinsics(cloud) : Error{""};
  if (grid && estimated.ok()) {
    image = KeepGrid(cloud, intrinsics != nullptr ? *intrinsics : *estimated, labels);
  } else {
    image = ProjectPoints(cloud, intrinsics != nullptr ? *intrinsics : Intrinsics{}, labels);
  }
  for (float depth_m : image.depth_m) {
    if (depth_m > 0) return image;
  }
  return Error{"cloud: no point has a finite position in front of the camera and in its view"};
}

}  // namespace beckon
