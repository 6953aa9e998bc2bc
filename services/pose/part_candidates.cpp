// Where an object may have a part of its own: points that stick out, and necks.
#include "services/pose/part_candidates.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace beckon::pose {
namespace {

constexpr double kSharp = 0.3, kRound = 1.0;

template <typename Keep>
PointBlock Collect(const PartsView& view, const Keep& keep) {
  PointBlock block;
  for (int i = 0; i < view.points_F.size; ++i) {
    if (keep(i)) block.Add(view.points_F.at(i), 1);
  }
  for (int i = 0; i < block.size; ++i) {
    block.weight[static_cast<size_t>(i)] = 1 / static_cast<float>(block.size);
  }
  if (block.size > 0) block.Pad();
  return block;
}

// Median distance of the points from their nearest neighbours.
double Spacing(const PointBlock& points) {
  std::vector<double> nearest(static_cast<size_t>(points.size), 1e9);
  for (int i = 0; i < points.size; ++i) {
    for (int k = 0; k < i; ++k) {
      const double d = (points.at(i) - points.at(k)).squaredNorm();
      nearest[static_cast<size_t>(i)] = std::min(nearest[static_cast<size_t>(i)], d);
      nearest[static_cast<size_t>(k)] = std::min(nearest[static_cast<size_t>(k)], d);
    }
  }
  const auto middle = nearest.begin() + points.size / 2;
  std::nth_element(nearest.begin(), middle, nearest.end());
  return std::sqrt(*middle);
}

// The largest set of points that are linked by steps of a few spacings.
PointBlock LargestGroup(const PointBlock& points) {
  constexpr double kLinks = 4;
  const double link = kLinks * Spacing(points);
  std::vector<int> group(static_cast<size_t>(points.size), -1), queue;
  int groups = 0, largest = 0;
  size_t most = 0;
  for (int seed = 0; seed < points.size; ++seed) {
    if (group[static_cast<size_t>(seed)] >= 0) continue;
    group[static_cast<size_t>(seed)] = groups;
    queue.assign(1, seed);
    for (size_t next = 0; next < queue.size(); ++next) {
      const Eigen::Vector3d p = points.at(queue[next]);
      for (int k = seed + 1; k < points.size; ++k) {
        if (group[static_cast<size_t>(k)] >= 0 || (points.at(k) - p).norm() > link) continue;
        group[static_cast<size_t>(k)] = groups;
        queue.push_back(k);
      }
    }
    if (queue.size() > most) most = queue.size(), largest = groups;
    ++groups;
  }
  PointBlock block;
  for (int i = 0; i < points.size; ++i) {
    if (group[static_cast<size_t>(i)] == largest)
      block.Add(points.at(i), 1.0 / static_cast<double>(most));
  }
  block.Pad();
  return block;
}

// The box around points along `up` and the horizontal direction nearest to `forward`.
Superquadric BoxAround(const PointBlock& points, const Eigen::Vector3d& up,
                       const Eigen::Vector3d& forward) {
  Superquadric box;
  Eigen::Vector3d ahead = forward - up * up.dot(forward);
  ahead = ahead.norm() > 1e-6 ? Eigen::Vector3d(ahead.normalized()) : up.unitOrthogonal();
  box.X_FO.linear() << ahead, up.cross(ahead), up;
  Eigen::Vector3d lo = Eigen::Vector3d::Constant(1e9), hi = -lo;
  for (int i = 0; i < points.size; ++i) {
    const Eigen::Vector3d q = box.X_FO.linear().transpose() * points.at(i);
    lo = lo.cwiseMin(q);
    hi = hi.cwiseMax(q);
  }
  box.semi_axes = (0.5 * (hi - lo)).cwiseMax(0.002);
  box.X_FO.translation() = box.X_FO.linear() * (0.5 * (hi + lo));
  box.epsilon.setConstant(kSharp);
  return box;
}

// Of a box and an upright cylinder that fill a group of points, fitted to it, that which makes the
// better model together with the others.
std::vector<Superquadric> WithGroup(const std::vector<Superquadric>& others,
                                    const PointBlock& points, const PartsView& view,
                                    const AdaptiveConfig& fit, const PartsConfig& config) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (int i = 0; i < points.size; ++i) middle += points.at(i) / points.size;
  const Superquadric box = BoxAround(points, view.up, middle - others[0].X_FO.translation());
  // As wide as seen from the camera, and as deep, from its nearest point on.
  Superquadric cylinder = BoxAround(points, view.up, middle - view.scene.viewpoint);
  const double radius = cylinder.semi_axes[1];
  cylinder.X_FO.translation() += cylinder.X_FO.linear().col(0) * (radius - cylinder.semi_axes[0]);
  cylinder.semi_axes[0] = radius;
  cylinder.epsilon = {kSharp, kRound};
  std::vector<Superquadric> best;
  double least = 0;
  for (const Superquadric& start : {box, cylinder}) {
    std::vector<Superquadric> parts = others;
    parts.push_back(
        FitLoosePart(points, view, start, fit, config.iterations, config.min_semi_axis_m));
    const double variance = Judge(parts, view, view.foreign_m()).variance_m2;
    if (!best.empty() && variance >= least) continue;
    best = std::move(parts);
    least = variance;
  }
  return best;
}

// The shape with its foot where it is and its top at `height` along `up`.
Superquadric WithTopAt(const Superquadric& shape, const Eigen::Vector3d& up, double height) {
  int axis;
  (shape.X_FO.linear().transpose() * up).cwiseAbs().maxCoeff(&axis);
  const double middle = up.dot(shape.X_FO.translation());
  const double foot = middle - shape.semi_axes[axis];
  Superquadric moved = shape;
  moved.semi_axes[axis] = std::max(0.5 * (height - foot), 0.002);
  moved.X_FO.translation() += up * (0.5 * (height + foot) - middle);
  return moved;
}

// Whether the image shows the background beyond the outline above `height`, and nothing in front.
bool OutlineIsOwnAbove(double height, const PartsView& view) {
  int farther = 0, hidden = 0, all = 0;
  for (const RimPoint& rim : view.rim_F) {
    if (view.up.dot(rim.point.cast<double>()) <= height) continue;
    ++all;
    farther += rim.beyond == Beyond::kFarther;
    hidden += rim.beyond == Beyond::kNearer || rim.beyond == Beyond::kImageBorder;
  }
  return 2 * farther > all && 20 * hidden < all;
}

struct Profile {
  static constexpr int kBins = 24;
  std::array<double, kBins> lo, hi;  // m, to the right as seen from the camera
  double foot = 1e9, top = -1e9;     // m along up

  double Width(int bin) const {
    const size_t k = static_cast<size_t>(bin);
    return std::max(hi[k] - lo[k], 0.0);
  }
};

Profile Measure(const PartsView& view) {
  Profile profile;
  profile.lo.fill(1e9);
  profile.hi.fill(-1e9);
  const PointBlock& points = view.points_F;
  const Eigen::Vector3d right =
      (points.at(points.size / 2) - view.scene.viewpoint).cross(view.up).normalized();
  for (int i = 0; i < points.size; ++i) {
    const double height = view.up.dot(points.at(i));
    profile.foot = std::min(profile.foot, height);
    profile.top = std::max(profile.top, height);
  }
  const double scale = Profile::kBins / std::max(profile.top - profile.foot, 1e-9);
  for (int i = 0; i < points.size; ++i) {
    const Eigen::Vector3d p = points.at(i);
    const double along = right.dot(p);
    const size_t bin = static_cast<size_t>(
        std::min(static_cast<int>((view.up.dot(p) - profile.foot) * scale), Profile::kBins - 1));
    profile.lo[bin] = std::min(profile.lo[bin], along);
    profile.hi[bin] = std::max(profile.hi[bin], along);
  }
  return profile;
}

}  // namespace

int FewestPoints(const PartsView& view, const PartsConfig& config) {
  return std::max(config.min_points, static_cast<int>(config.min_share * view.points_F.size));
}

bool SomethingSticksOut(const PartModel& model, const PartsView& view, const PartsConfig& config) {
  int outside = 0;
  for (int i = 0; i < view.points_F.size; ++i) {
    outside += static_cast<double>(model.DistanceOf(i)) > view.outside_m;
  }
  return outside >= FewestPoints(view, config);
}

std::vector<Superquadric> WithProtrudingPart(const PartModel& model, const PartsView& view,
                                             const AdaptiveConfig& fit, const PartsConfig& config) {
  const PointBlock outside = Collect(
      view, [&](int i) { return static_cast<double>(model.DistanceOf(i)) > view.outside_m; });
  if (outside.size < FewestPoints(view, config)) return {};
  const std::vector<bool> through =
      SeenThrough(model.parts[0], view.scene.viewpoint, outside, view.outside_m);
  PointBlock sound;
  for (int i = 0; i < outside.size; ++i) {
    if (!through[static_cast<size_t>(i)]) sound.Add(outside.at(i), 1);
  }
  if (sound.size < FewestPoints(view, config)) return {};
  const PointBlock group = LargestGroup(sound);
  if (group.size < FewestPoints(view, config)) return {};
  return WithGroup(model.parts, group, view, fit, config);
}

std::optional<double> NeckHeight(const PartsView& view, const PartsConfig& config) {
  const Profile profile = Measure(view);
  // The split of the widths into two levels of the least squares (Otsu 1979): the largest between
  // them.
  constexpr double kCone = 1.15;
  constexpr int kFewest = 2, kBins = Profile::kBins;
  double total = 0, below = 0, step = 0, moment = 0;
  for (int bin = 0; bin < kBins; ++bin) {
    total += profile.Width(bin);
    moment += profile.Width(bin) * (bin - 0.5 * (kBins - 1));
  }
  int split = 0;
  double ratio = 1;
  for (int bin = 0; bin < kBins - kFewest; ++bin) {
    below += profile.Width(bin);
    const int n = bin + 1, m = kBins - n;
    const double low = below / n, high = (total - below) / m;
    const double explained = (low - high) * (low - high) * n * m / kBins;
    if (n < kFewest || high >= low || explained <= step) continue;
    step = explained;
    split = n;
    ratio = high / low;
  }
  // A straight line through the widths explains this much of them: clearly more for a cone or a
  // dome.
  const double slope = moment * moment * 12 / (kBins * (kBins * kBins - 1.0));
  if (slope > kCone * step) return {};
  const double height = profile.foot + (profile.top - profile.foot) * split / kBins;
  if (split == 0 || ratio > config.neck_width || profile.top - height < config.neck_height_m) {
    return {};
  }
  return height;
}

std::vector<Superquadric> BodyAndNeck(const Superquadric& single, double height,
                                      const PartsView& view, const AdaptiveConfig& fit,
                                      const PartsConfig& config) {
  constexpr double kDrawnOut_m = 0.5;  // well above any object
  constexpr double kOwnShare = 0.35;   // of the points above, most that lie on the body drawn out
  const auto height_of = [&](int i) { return view.up.dot(view.points_F.at(i)); };
  const PointBlock lower =
      Collect(view, [&](int i) { return i % 2 == 0 && height_of(i) <= height; });  // half will do
  const PointBlock upper = Collect(view, [&](int i) { return height_of(i) > height; });
  if (std::min(lower.size, upper.size) < FewestPoints(view, config)) return {};
  PointBlock none;
  const Superquadric start = WithTopAt(single, view.up, height);
  const AdaptiveProblem problem(lower, none, view.scene, UprightAxis(start, view.scene.table), fit);
  FitBounds bounds;
  bounds.min_axes.setConstant(fit.min_semi_axis_m);
  bounds.max_axes = 1.3 * start.semi_axes.cwiseMax(fit.min_semi_axis_m);
  bounds.min_epsilon = fit.min_epsilon;
  bounds.max_epsilon = fit.max_epsilon;
  const Superquadric body = Minimise(problem, start, bounds, {config.iterations, 1e-4}).shape;
  BlockDistances distances;
  ComputeDistances(WithTopAt(body, view.up, height + kDrawnOut_m), upper, distances);
  int own = 0;
  for (int i = 0; i < upper.size; ++i) {
    own += std::abs(static_cast<double>(distances[static_cast<size_t>(i)])) < view.outside_m;
  }
  if (own > kOwnShare * upper.size && !OutlineIsOwnAbove(height, view)) return {};
  return WithGroup({body}, upper, view, fit, config);
}

}  // namespace beckon::pose
