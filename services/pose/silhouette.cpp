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
  bool usable;              // far enough from the table
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

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Andrew's monotone chain.
std::vector<Eigen::Vector2d> ConvexHull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  std::vector<Eigen::Vector2d> hull;
  for (int side = 0; side < 2; ++side) {
    const size_t base = hull.size();
    for (const auto& p : points) {
      while (hull.size() >= base + 2 &&
             Cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

struct Chord {
  Eigen::Vector2d from, to;
  double length;
};

// Chords of the hull from which no vertex between their ends is farther than `tolerance`, longest
// first.
std::vector<Chord> StraightChords(const std::vector<Eigen::Vector2d>& hull, double tolerance) {
  std::vector<Chord> chords;
  const size_t n = hull.size();
  for (size_t i = 0; i < n; ++i) {
    Chord longest{hull[i], hull[i], 0};
    for (size_t k = 1; k < n; ++k) {
      const Eigen::Vector2d end = hull[(i + k) % n], along = end - hull[i];
      const double length = along.norm();
      bool straight = true;
      for (size_t m = 1; m < k && straight; ++m) {
        straight = std::abs(Cross(along, hull[(i + m) % n] - hull[i])) <= tolerance * length;
      }
      if (!straight) break;
      longest = {hull[i], end, length};
    }
    chords.push_back(longest);
  }
  std::stable_sort(chords.begin(), chords.end(),
                   [](const Chord& a, const Chord& b) { return a.length > b.length; });
  return chords;
}

// `to_F` turns a direction of the image plane, in pixels and their focal length, to F.
std::vector<Straight> FindStraights(const std::vector<OutlinePoint>& outline,
                                    const std::vector<Eigen::Vector2d>& hull, double pixel_rad,
                                    const Eigen::Matrix3d& to_F) {
  constexpr double kTolerance_px = 1.2, kNear_px = 2.0;
  constexpr size_t kMostStraights = 6;
  constexpr double kShortest = 0.3;  // of the longest distance in the outline
  double diameter = 0;
  for (const auto& p : hull) {
    for (const auto& q : hull) diameter = std::max(diameter, (p - q).norm());
  }
  std::vector<Straight> straights;
  std::vector<bool> taken(outline.size(), false);
  for (const Chord& chord : StraightChords(hull, kTolerance_px)) {
    if (chord.length < kShortest * diameter || straights.size() == kMostStraights) break;
    const Eigen::Vector2d along = (chord.to - chord.from) / chord.length;
    const Eigen::Vector2d outward(along.y(), -along.x());  // the hull runs counter-clockwise
    Straight straight;
    int fresh = 0;
    double sum = 0, squares = 0;
    for (size_t i = 0; i < outline.size(); ++i) {
      const Eigen::Vector2d q = outline[i].image - chord.from;
      const double s = along.dot(q);
      if (std::abs(Cross(along, q)) > kNear_px || s < -kNear_px || s > chord.length + kNear_px) {
        continue;
      }
      straight.rays.push_back(static_cast<int>(i));
      fresh += taken[i] ? 0 : 1;
      const double deviation = outward.dot(q);
      sum += deviation;
      squares += deviation * deviation;
    }
    const double n = static_cast<double>(straight.rays.size());
    if (2 * fresh < static_cast<int>(n) || n * 12 < static_cast<double>(outline.size())) continue;
    for (int i : straight.rays) taken[static_cast<size_t>(i)] = true;
    straight.mean_square_rad =
        std::max(squares / n - (sum / n) * (sum / n), 0.0) * pixel_rad * pixel_rad;
    double lowest = 0;
    for (const auto& p : hull) lowest = std::min(lowest, outward.dot(p - chord.from));
    straight.width_rad = -lowest * pixel_rad;
    // n·(u, v, 1) = outward·(q - from) in units of the focal length.
    const double offset = (outward.dot(chord.from) + 0.5) * pixel_rad;
    straight.normal_F = (to_F * Eigen::Vector3d(outward.x(), outward.y(), -offset)).normalized();
    straights.push_back(std::move(straight));
  }
  return straights;
}

// Pixels of the image plane of `axes`; nothing where a point is not in front of the viewpoint.
std::optional<Eigen::Vector2d> ToImage(const Eigen::Matrix3d& axes, const Eigen::Vector3d& arm_F,
                                       double pixel_rad) {
  const Eigen::Vector3d q = axes.transpose() * arm_F;
  if (q.z() <= 1e-6) return std::nullopt;
  return Eigen::Vector2d(q.head<2>() / (q.z() * pixel_rad));
}

bool IsCutOff(const RimPoint& r) {
  return r.beyond == Beyond::kNearer || r.beyond == Beyond::kImageBorder;
}

// The piece of a rim from its point `first` on, `count` points long, as if it were straight.
// `turn`: 1 where the rim runs counter-clockwise in the image, else -1.
Straight CutAlong(const std::vector<Eigen::Vector2d>& image, size_t first, size_t count,
                  double turn, double pixel_rad, const Eigen::Matrix3d& axes) {
  const size_t n = image.size();
  // From the neighbour before to the neighbour after.
  const Eigen::Vector2d along =
      (image[(first + count) % n] - image[(first + n - 1) % n]).stableNormalized();
  const Eigen::Vector2d outward = turn * Eigen::Vector2d(along.y(), -along.x());
  double offset = 0, lowest = 1e9;
  for (size_t k = 0; k < count; ++k) offset += outward.dot(image[(first + k) % n]);
  offset /= static_cast<double>(count);
  for (const auto& q : image) lowest = std::min(lowest, outward.dot(q));
  Straight cut;
  cut.width_rad = std::max(offset - lowest, 0.0) * pixel_rad;
  cut.normal_F =
      (axes * Eigen::Vector3d(outward.x(), outward.y(), -offset * pixel_rad)).normalized();
  return cut;
}

// The longest pieces of the rim that occluders or the image's border take away; gaps of a point or
// two in them do not count.
std::vector<Straight> CutsOf(std::span<const RimPoint> rim_F,
                             const std::vector<Eigen::Vector2d>& image, double turn,
                             double pixel_rad, const Eigen::Matrix3d& axes) {
  constexpr size_t kMostCuts = 3, kGap = 2;
  constexpr double kShortest = 0.06;  // of the rim
  const size_t n = image.size();
  size_t start = 0;  // a point that is not cut off, if there is one
  while (start < n && IsCutOff(rim_F[start])) ++start;
  if (start == n) return {};  // cut off all around: nothing is known of any side
  struct Run {
    size_t first, count;
  };
  std::vector<Run> runs;
  for (size_t k = 0; k < n; ++k) {
    if (!IsCutOff(rim_F[(start + k) % n])) continue;
    if (!runs.empty() && k - (runs.back().first + runs.back().count) <= kGap) {
      runs.back().count = k - runs.back().first + 1;
    } else {
      runs.push_back({k, 1});
    }
  }
  std::stable_sort(runs.begin(), runs.end(),
                   [](const Run& a, const Run& b) { return a.count > b.count; });
  std::vector<Straight> cuts;
  for (const Run& run : runs) {
    if (cuts.size() == kMostCuts ||
        static_cast<double>(run.count) < kShortest * static_cast<double>(n))
      break;
    cuts.push_back(CutAlong(image, (start + run.first) % n, run.count, turn, pixel_rad, axes));
  }
  return cuts;
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
  silhouette.cuts = CutsOf(rim_F, image, area > 0 ? 1 : -1, config.pixel_rad, axes);
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

  std::vector<OutlinePoint> outline;
  std::vector<Eigen::Vector2d> border;
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
        border.push_back(image[point]);
        if (!RunsAcross(extreme, points_of, line)) continue;
        const bool usable = !table_F || table_F->Distance(points_F[point]) >= config.table_margin_m;
        if (usable) outline.push_back({border.back(), outward, usable});
      }
    }
  }
  if (outline.empty()) return silhouette;
  const size_t step = (outline.size() + static_cast<size_t>(config.most_rays) - 1) /
                      static_cast<size_t>(config.most_rays);
  std::vector<OutlinePoint> chosen;
  for (size_t i = 0; i < outline.size(); i += step) chosen.push_back(outline[i]);
  for (const OutlinePoint& o : chosen) {
    const Eigen::Vector2d q = (o.image + o.outward) * pixel_rad;
    silhouette.rays_F.Add((axes * Eigen::Vector3d(q.x(), q.y(), 1)).normalized(),
                          1.0 / static_cast<double>(chosen.size()));
  }
  silhouette.rays_F.Pad();
  silhouette.straights = FindStraights(chosen, ConvexHull(std::move(border)), pixel_rad, axes);
  return silhouette;
}

}  // namespace beckon::pose
