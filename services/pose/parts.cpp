// Several superquadrics for an object that one does not describe.
#include "services/pose/parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/pose/part_candidates.h"
#include "services/pose/part_model.h"
#include "services/pose/round_body.h"
#include "services/pose/silhouette.h"

namespace beckon::pose {
namespace {

constexpr int kPartParameters = 11;

// Depth noise of a structured-light camera at a distance (Nguyen, Izadi & Lovell 2012), m.
double CameraNoise(double distance_m) {
  const double beyond = distance_m - 0.4;
  return 0.0012 + 0.0019 * beyond * beyond;
}

// At most a block of the points, one from each stretch of the cloud, at a place that does not
// repeat from row to row of an image.
PointBlock Sample(const PointList& points) {
  PointBlock block;
  const double count = static_cast<double>(std::min<size_t>(points.size(), kBlockSize));
  const double stretch = static_cast<double>(points.size()) / count;
  for (int i = 0; i < static_cast<int>(count); ++i) {
    const double turn = i / std::numbers::phi;
    const size_t k = static_cast<size_t>((i + turn - std::floor(turn)) * stretch);
    block.Add(points[std::min(k, points.size() - 1)], 1 / count);
  }
  block.Pad();
  return block;
}

double MedianDistance(const PartModel& model, int size) {
  BlockDistances magnitudes;
  for (int i = 0; i < size; ++i) magnitudes[static_cast<size_t>(i)] = std::abs(model.DistanceOf(i));
  const auto middle = magnitudes.begin() + size / 2;
  std::nth_element(magnitudes.begin(), middle, magnitudes.begin() + size);
  return static_cast<double>(*middle);
}

// Schwarz's criterion in nats, positive where the larger model is worth its parameters.
double Gain(const PartModel& now, const PartModel& more, const PartsView& view,
            const PartsConfig& config) {
  const double n = std::min(view.points_F.size, config.witnesses);
  const double parts = static_cast<double>(more.parts.size() - now.parts.size());
  return 0.5 * n * std::log(now.variance_m2 / more.variance_m2) -
         0.5 * kPartParameters * parts * std::log(n);
}

// Whether the points of a part show a body of its own: most lie outside the main one, the outermost
// well so, its centre is not within the main one (that would be the main one told again), and
// neither of the two would hide them, were it solid (points of a thin handle may lie a little
// behind its surface).
bool IsBody(const PartModel& model, size_t part, const PartsView& view, const PartsConfig& config) {
  constexpr double kMost = 0.8;
  constexpr double kLeastApart =
      0.9;  // of the way to the main body's surface lies the part's centre
  const Superquadric& main = model.parts[0];
  if (Gauge(main, main.X_FO.inverse() * model.parts[part].X_FO.translation()) < kLeastApart)
    return false;
  PointBlock own;
  int outside = 0, inside = 0, far_out = 0;
  for (int i = 0; i < view.points_F.size; ++i) {
    const size_t k = static_cast<size_t>(i);
    if (model.Nearest(i) != part ||
        std::abs(static_cast<double>(model.distances_m[part][k])) > view.outside_m) {
      continue;
    }
    own.Add(view.points_F.at(i), 1);
    const double from_main = static_cast<double>(model.distances_m[0][k]);
    outside += from_main > 0.5 * view.outside_m;
    far_out += from_main > config.min_protrusion_m;
    inside += from_main < -0.5 * view.outside_m;
  }
  if (outside < FewestPoints(view, config) || outside < kMost * (outside + inside) ||
      2 * outside < own.size || 10 * far_out < own.size) {
    return false;
  }
  const std::vector<bool> behind_main =
      SeenThrough(main, view.scene.viewpoint, own, view.outside_m);
  const std::vector<bool> behind_itself =
      SeenThrough(model.parts[part], view.scene.viewpoint, own, 2 * view.outside_m);
  int seen = 0;
  for (size_t i = 0; i < behind_main.size(); ++i) seen += !behind_main[i] && !behind_itself[i];
  return seen >= kMost * own.size;
}

bool AreBodies(const PartModel& model, const PartsView& view, const PartsConfig& config) {
  for (size_t part = 1; part < model.parts.size(); ++part) {
    if (!IsBody(model, part, view, config)) return false;
  }
  return true;
}

bool IsAstray(const PartModel& model, const PartsView& view, const PartsConfig& config) {
  return model.variance_m2 > std::pow(config.astray_sigmas * view.noise_m, 2);
}

class Search {
 public:
  Search(const PointList& points, const AdaptiveConfig& fit, const PartsConfig& config,
         PartsView& view)
      : points_(points), fit_(fit), config_(config), view_(view) {}

  // The first model with a part more than `now` that pays, of those that start best first; or one
  // without parts.
  PartModel Extend(const PartModel& now, std::optional<double> neck_height) {
    std::vector<std::vector<Superquadric>> candidates;
    if (neck_height)
      candidates.push_back(BodyAndNeck(now.parts[0], *neck_height, view_, fit_, config_));
    candidates.push_back(WithProtrudingPart(now, view_, fit_, config_));
    if (now.parts.size() == 1) {
      if (const auto body = FindRoundBody(view_, config_.round_share)) {
        candidates.push_back(
            WithProtrudingPart(Judge({*body}, view_, view_.foreign_m()), view_, fit_, config_));
      }
    }
    std::vector<PartModel> models;
    for (auto& parts : candidates) {
      if (!parts.empty()) models.push_back(Judge(std::move(parts), view_, view_.foreign_m()));
    }
    std::stable_sort(models.begin(), models.end(), [](const PartModel& a, const PartModel& b) {
      return a.variance_m2 < b.variance_m2;
    });
    for (const PartModel& start : models) {
      PartModel model = Alternate(start);
      if (Gain(now, model, view_, config_) > 0 && AreBodies(model, view_, config_)) return model;
    }
    return {};
  }

 private:
  PartModel Alternate(PartModel model) {
    if (view_.rays_F.size == 0) {
      view_.rays_F = TraceSilhouette(points_, view_.rim_F, view_.scene.viewpoint, view_.scene.table,
                                     {fit_.outline_rays / 2, fit_.pixel_rad, fit_.table_margin_m})
                         .rays_F;
    }
    for (int round = 0; round < config_.rounds; ++round) {
      PartModel refitted =
          Judge(Refit(model, view_, fit_, config_.iterations, config_.min_semi_axis_m), view_,
                view_.foreign_m());
      if (refitted.variance_m2 < model.variance_m2) model = std::move(refitted);
    }
    return model;
  }

  const PointList& points_;
  const AdaptiveConfig& fit_;
  const PartsConfig& config_;
  PartsView& view_;
};

}  // namespace

std::vector<Superquadric> FindParts(const PointList& points_F, const std::optional<Plane>& table_F,
                                    const Eigen::Vector3d& viewpoint_F,
                                    std::span<const RimPoint> rim_F, const Superquadric& single,
                                    const AdaptiveConfig& fit, const PartsConfig& config) {
  if (config.most_parts < 2 || points_F.size() < 2 * static_cast<size_t>(config.min_points))
    return {};
  PartsView view;
  view.points_F = Sample(points_F);
  view.rim_F = rim_F;
  view.scene = {table_F, viewpoint_F, single.semi_axes.array().log().sum()};
  view.up = table_F ? table_F->normal : Eigen::Vector3d(single.X_FO.linear().col(2));
  view.noise_m = CameraNoise((single.X_FO.translation() - viewpoint_F).norm());
  PartModel model = Judge({single}, view, 1);
  view.outside_m = std::max({config.outside_m, config.outside_sigmas * view.noise_m,
                             config.outside_medians * MedianDistance(model, view.points_F.size)});
  const std::optional<double> neck_height = NeckHeight(view, config);
  model.variance_m2 = Variance(model, view, view.foreign_m());
  if (!neck_height && !SomethingSticksOut(model, view, config) && !IsAstray(model, view, config)) {
    return {};
  }
  Search search(points_F, fit, config, view);
  for (int parts = 1; parts < config.most_parts; ++parts) {
    PartModel more = search.Extend(model, parts == 1 ? neck_height : std::nullopt);
    if (more.parts.empty()) break;
    model = std::move(more);
  }
  return model.parts.size() > 1 ? model.parts : std::vector<Superquadric>{};
}

}  // namespace beckon::pose
