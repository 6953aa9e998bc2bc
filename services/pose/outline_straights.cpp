// Straight pieces of an outline, and where it is known to be cut off.
#include "services/pose/outline_straights.h"

#include <algorithm>

namespace beckon::pose {
namespace {

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

}  // namespace

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

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

std::vector<Straight> FindStraights(const std::vector<Eigen::Vector2d>& outline,
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
      const Eigen::Vector2d q = outline[i] - chord.from;
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

std::vector<Straight> FindCuts(std::span<const RimPoint> rim_F,
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

}  // namespace beckon::pose
