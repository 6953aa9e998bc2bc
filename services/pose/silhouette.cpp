// The outline of an object as rays that graze it.
#include "services/pose/silhouette.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace beckon::pose {
namespace {

constexpr int kMaxLines = 1024;  // rows or columns of the grid; wider objects get coarser pixels

// A point of the outline in pixels of the grid, and the ray's slope it stands for.
struct OutlinePoint {
  Eigen::Vector2d image;    // px, where it was seen
  Eigen::Vector2d outward;  // px, to the outline
  size_t point;             // its index
};

// The image plane: z along the line of sight unless that is within 60 degrees of F's own z.
Eigen::Matrix3d ImageAxes(const Eigen::Vector3d& sight) {
  if (sight.z() > 0.5) return Eigen::Matrix3d::Identity();
  Eigen::Matrix3d axes;
  axes.col(2) = sight;
  axes.col(0) = sight.unitOrthogonal();
  axes.col(1) = sight.cross(axes.col(0));
  return axes;
}

// Where the centres of the pixels lie between integers: the circular mean of the fractions.
double Phase(const std::vector<Eigen::Vector2d>& image, int axis) {
  double c = 0, s = 0;
  const size_t step = std::max<size_t>(image.size() / 200, 1);
  for (size_t i = 0; i < image.size(); i += step) {
    const double turn = 2 * std::numbers::pi * image[i][axis];
    c += std::cos(turn);
    s += std::sin(turn);
  }
  return std::atan2(s, c) / (2 * std::numbers::pi);
}

// The outermost points of each line of the grid along `axis` (0: rows, their leftmost and rightmost
// points).
struct Extremes {
  std::vector<double> lo, hi;  // px along `axis`
  std::vector<int> lo_point, hi_point;
};

void FindExtremes(const std::vector<Eigen::Vector2d>& image, int axis, double first, int lines,
                  Extremes& e) {
  e.lo.assign(static_cast<size_t>(lines), 1e9);
  e.hi.assign(static_cast<size_t>(lines), -1e9);
  e.lo_point.assign(static_cast<size_t>(lines), -1);
  e.hi_point.assign(static_cast<size_t>(lines), -1);
  for (size_t i = 0; i < image.size(); ++i) {
    const size_t line = static_cast<size_t>(
        std::clamp(static_cast<int>(std::floor(image[i][1 - axis] - first)), 0, lines - 1));
    const double along = image[i][axis];
    if (along < e.lo[line]) e.lo[line] = along, e.lo_point[line] = static_cast<int>(i);
    if (along > e.hi[line]) e.hi[line] = along, e.hi_point[line] = static_cast<int>(i);
  }
}

// Whether the outline runs across the lines here, by no more than 45 degrees: else the other
// direction's lines see it better.
bool RunsAcross(const std::vector<double>& extreme, const std::vector<int>& point, size_t line) {
  constexpr size_t kReach = 3;
  size_t before = line, after = line;
  for (size_t k = 1; k <= kReach; ++k) {
    if (line >= k && point[line - k] >= 0) before = line - k;
    if (line + k < extreme.size() && point[line + k] >= 0) after = line + k;
  }
  if (before == after) return false;
  return std::abs(extreme[after] - extreme[before]) <= static_cast<double>(after - before);
}

// The outermost points of each row and column of a grid of pixels.
struct ImageOutline {
  std::vector<OutlinePoint> points;     // where the outline runs across the line
  std::vector<Eigen::Vector2d> border;  // px, all of them
};

ImageOutline FindOutline(const std::vector<Eigen::Vector2d>& image, const Eigen::Vector2d& lo,
                         const Eigen::Vector2d& hi) {
  ImageOutline found;
  for (int axis = 0; axis < 2; ++axis) {
    const double first = std::floor(lo[1 - axis]) + Phase(image, 1 - axis) - 1.5;
    const int lines = static_cast<int>(std::floor(hi[1 - axis] - first)) + 1;
    Extremes e;
    FindExtremes(image, axis, first, lines, e);
    // One side after the other: every so manieth of them is then of both.
    for (const bool high : {false, true}) {
      const std::vector<double>& extreme = high ? e.hi : e.lo;
      const std::vector<int>& points_of = high ? e.hi_point : e.lo_point;
      Eigen::Vector2d outward = Eigen::Vector2d::Zero();
      outward[axis] = high ? 0.5 : -0.5;
      for (size_t line = 0; line < extreme.size(); ++line) {
        if (points_of[line] < 0) continue;
        const size_t point = static_cast<size_t>(points_of[line]);
        found.border.push_back(image[point]);
        if (RunsAcross(extreme, points_of, line))
          found.points.push_back({image[point], outward, point});
      }
    }
  }
  return found;
}

// Pixels of the image plane of `axes`; nothing where a point is not in front of the viewpoint.
std::optional<Eigen::Vector2d> ToImage(const Eigen::Matrix3d& axes, const Eigen::Vector3d& arm_F,
                                       double pixel_rad) {
  const Eigen::Vector3d q = axes.transpose() * arm_F;
  if (q.z() <= 1e-6) return std::nullopt;
  return Eigen::Vector2d(q.head<2>() / (q.z() * pixel_rad));
}

// The silhouette of a rim, whose points run around the object in order.
Silhouette SilhouetteOfRim(std::span<const RimPoint> rim_F, const Eigen::Vector3d& viewpoint_F,
                           const std::optional<Plane>& table_F, const Eigen::Matrix3d& axes,
                           const SilhouetteConfig& config) {
  Silhouette silhouette;
  std::vector<Eigen::Vector2d> image;
  for (const RimPoint& r : rim_F) {
    const auto q = ToImage(axes, r.point.cast<double>() - viewpoint_F, config.pixel_rad);
    if (!q) return silhouette;
    image.push_back(*q);
  }
  const size_t n = image.size();
  double area = 0;
  for (size_t i = 0; i < n; ++i) area += Cross(image[i], image[(i + 1) % n]);
  std::vector<Eigen::Vector3d> rays;
  for (size_t i = 0; i < n && rays.size() < static_cast<size_t>(kBlockSize); ++i) {
    if (rim_F[i].beyond != Beyond::kFarther) continue;
    if (table_F && table_F->Distance(rim_F[i].point.cast<double>()) < config.table_margin_m)
      continue;
    const Eigen::Vector2d along = image[(i + 1) % n] - image[(i + n - 1) % n];
    const Eigen::Vector2d outward = Eigen::Vector2d(along.y(), -along.x()) * (area > 0 ? 1 : -1);
    const Eigen::Vector2d q = (image[i] + 0.5 * outward.stableNormalized()) * config.pixel_rad;
    rays.push_back((axes * Eigen::Vector3d(q.x(), q.y(), 1)).normalized());
  }
  // By the length of the rim: where little of it is the object's own, that says little.
  for (const auto& ray : rays) silhouette.rays_F.Add(ray, 1.0 / static_cast<double>(n));
  silhouette.rays_F.Pad();
  silhouette.cuts = FindCuts(rim_F, image, area > 0 ? 1 : -1, config.pixel_rad, axes);
  return silhouette;
}

}  // namespace

Silhouette TraceSilhouette(std::span<const Eigen::Vector3d> points_F,
                           std::span<const RimPoint> rim_F, const Eigen::Vector3d& viewpoint_F,
                           const std::optional<Plane>& table_F, const SilhouetteConfig& config) {
  Silhouette silhouette;
  Eigen::Vector3d sight = Eigen::Vector3d::Zero();
  for (const auto& p : points_F) sight += p - viewpoint_F;
  if (points_F.empty() || config.most_rays <= 0 || sight.norm() < 1e-6) return silhouette;
  const Eigen::Matrix3d axes = ImageAxes(sight.normalized());

  if (!rim_F.empty()) return SilhouetteOfRim(rim_F, viewpoint_F, table_F, axes, config);

  std::vector<Eigen::Vector2d> image;
  image.reserve(points_F.size());
  Eigen::Vector2d lo(1e9, 1e9), hi(-1e9, -1e9);
  for (const auto& p : points_F) {
    const auto q = ToImage(axes, p - viewpoint_F, config.pixel_rad);
    if (!q) return silhouette;
    image.push_back(*q);
    lo = lo.cwiseMin(image.back());
    hi = hi.cwiseMax(image.back());
  }
  const double coarser = std::max((hi - lo).maxCoeff() / (kMaxLines - 4), 1.0);
  const double pixel_rad = config.pixel_rad * coarser;
  if (coarser > 1) {
    for (auto& q : image) q /= coarser;
    lo /= coarser;
    hi /= coarser;
  }

  const ImageOutline found = FindOutline(image, lo, hi);
  std::vector<OutlinePoint> outline;
  for (const OutlinePoint& o : found.points) {
    if (!table_F || table_F->Distance(points_F[o.point]) >= config.table_margin_m) {
      outline.push_back(o);
    }
  }
  if (outline.empty()) return silhouette;
  const size_t step = (outline.size() + static_cast<size_t>(config.most_rays) - 1) /
                      static_cast<size_t>(config.most_rays);
  std::vector<OutlinePoint> chosen;
  for (size_t i = 0; i < outline.size(); i += step) chosen.push_back(outline[i]);
  std::vector<Eigen::Vector2d> seen;
  for (const OutlinePoint& o : chosen) {
    seen.push_back(o.image);
    const Eigen::Vector2d q = (o.image + o.outward) * pixel_rad;
    silhouette.rays_F.Add((axes * Eigen::Vector3d(q.x(), q.y(), 1)).normalized(),
                          1.0 / static_cast<double>(chosen.size()));
  }
  silhouette.rays_F.Pad();
  silhouette.straights = FindStraights(seen, ConvexHull(found.border), pixel_rad, axes);
  return silhouette;
}

}  // namespace beckon::pose
