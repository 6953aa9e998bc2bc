// The default fit: several starts, a robust distance to the surface, and what a table-top scene
// knows.
#include "services/pose/fit_adaptive.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "services/pose/adaptive_problem.h"
#include "services/pose/even_spread.h"
#include "services/pose/silhouette.h"
#include "services/pose/starts.h"
#include "services/pose/surface.h"

namespace beckon::pose {
namespace {

// Every so manieth of the points, at most `most`; the weights sum to 1.
PointBlock Block(const SpreadPoints& spread, int most) {
  const size_t limit = static_cast<size_t>(std::min(most, kBlockSize));
  const size_t step = std::max<size_t>((spread.points.size() + limit - 1) / limit, 1);
  double sum = 0;
  for (size_t i = 0; i < spread.points.size(); i += step) sum += spread.weights[i];
  PointBlock block;
  for (size_t i = 0; i < spread.points.size(); i += step) {
    block.Add(spread.points[i], spread.weights[i] / sum);
  }
  block.Pad();
  return block;
}

// The outline as it is taken to be: whole, or cut off along a straight piece.
struct View {
  PointBlock rays;
  PointBlock few_rays;  // for coarse fits
  Cut cut;
  double charge = 0;  // m^2, for the cut's improbability
  double ragged = 0;  // m^2, what the cut's rays cost about their straight line
};

View CutAt(const Silhouette& silhouette, const Straight& straight, double distance,
           const AdaptiveConfig& config) {
  View view{silhouette.rays_F, {}, {straight.normal_F}, config.cut_nats * config.nat_m2};
  const double width = straight.width_rad * distance;
  view.cut.beyond_m = config.cut_beyond * width;
  view.cut.sigma_m = std::max(config.cut_sigma * width, 1e-3);
  const double ragged = straight.mean_square_rad * distance * distance;
  for (int i : straight.rays) {
    float& weight = view.rays.weight[static_cast<size_t>(i)];
    const double scale2 = config.outline_noise_m * config.outline_noise_m;
    view.ragged += static_cast<double>(weight) * config.outline_weight * scale2 * std::log1p(ragged / scale2);
    weight = 0;
  }
  return view;
}

PointBlock EveryThird(const PointBlock& block) {
  PointBlock third;
  for (int i = 0; i < block.size; i += 3) third.Add(block.at(i), 3.0 * static_cast<double>(block.weight[static_cast<size_t>(i)]));
  third.Pad();
  return third;
}

struct Candidate {
  LmResult result;
  size_t view;
  double cost;
  double points_cost, outline_cost;  // m^2
  double outline_share;  // what the outline's weight is to be multiplied by
};

// Whether the side of the shape that faces the camera reaches `gap_m` lower than the points do: its
// foot is hidden behind another object, or it stands on one, and how far down it goes is not known.
bool FootIsUnseen(const Superquadric& shape, const PointList& points, const TableTopScene& scene,
                  double gap_m) {
  constexpr int kSamples = 150;
  constexpr double kGrazing = 0.14;  // sine of the angle below which cameras see little
  if (!scene.table) return false;
  std::vector<double> heights;
  for (const auto& p : points) heights.push_back(scene.table->Distance(p));
  const auto low = heights.begin() + static_cast<long>(heights.size() / 50);
  std::nth_element(heights.begin(), low, heights.end());
  for (const Eigen::Vector3d& p : SampleSurface(shape, kSamples)) {
    if (scene.table->Distance(p) > *low - gap_m) continue;
    const Eigen::Vector3d normal_F =
        shape.X_FO.linear() * NormalAt(shape, shape.X_FO.inverse() * p);
    if (normal_F.dot((p - scene.viewpoint).normalized()) < -kGrazing) return true;
  }
  return false;
}

}  // namespace

MethodOutcome FitAdaptive(const PointList& points_F, const std::optional<Plane>& table_F,
                          const Eigen::Vector3d& viewpoint_F, std::span<const RimPoint> rim_F,
                          const AdaptiveConfig& config) {
  const SpreadPoints weighted = SpreadEvenly(points_F, config.fine_points);
  const PointList& spread = weighted.points;
  const std::vector<Superquadric> starts = Starts(spread, table_F);
  const double reach = starts[0].semi_axes.maxCoeff();
  const PointBlock fine = Block(weighted, kBlockSize), coarse = Block(weighted, config.coarse_points);
  const TableTopScene scene{table_F, viewpoint_F, starts[0].semi_axes.array().log().sum()};
  const Silhouette silhouette =
      TraceSilhouette(points_F, rim_F, viewpoint_F, table_F,
                      {config.outline_rays, config.pixel_rad, config.table_margin_m});
  FitBounds bounds;
  bounds.min_axes.setConstant(config.min_semi_axis_m);
  bounds.max_axes.setConstant(std::max(reach * (1 + config.axis_margin), config.min_semi_axis_m));
  bounds.min_epsilon = config.min_epsilon;
  bounds.max_epsilon = config.max_epsilon;

  MethodOutcome outcome;
  const Eigen::Vector3d middle = spread[spread.size() / 2];
  const double distance = (middle - viewpoint_F).norm();
  std::vector<View> views{{silhouette.rays_F, {}, {}, 0}};
  if (silhouette.cut) {
    views[0] = CutAt(silhouette, *silhouette.cut, distance, config);
    views[0].charge = 0;  // nothing improbable: it was seen
  } else if (config.cut_hypotheses) {
    for (const Straight& s : silhouette.straights) views.push_back(CutAt(silhouette, s, distance, config));
  }
  for (View& view : views) view.few_rays = EveryThird(view.rays);
  LmOptions options{config.coarse_iterations, 1e-3};
  std::vector<Candidate> candidates;
  const auto fit = [&](const PointBlock& points, size_t view, const Superquadric& start, double share) {
    const bool is_coarse = &points == &coarse;
    AdaptiveProblem problem(points, is_coarse ? views[view].few_rays : views[view].rays, scene, UprightAxis(start, table_F), config,
                            views[view].cut);
    problem.set_outline_share(share);
    problem.set_search_steps(is_coarse ? 9 : 13);
    const LmResult result = Minimise(problem, start, bounds, options);
    outcome.iterations.push_back(result.iterations);
    problem.set_outline_share(1);
    const AdaptiveCost cost = problem.CostOf(result.shape);
    const double outline = (cost.outline + views[view].ragged) / config.outline_trust_m2;
    return Candidate{result, view,
                     cost.points + cost.support + cost.tilt + cost.volume + views[view].charge +
                         config.outline_trust_m2 * std::log1p(outline),
                     cost.points, cost.outline, 1 / (1 + outline)};
  };
  const auto cheaper = [](const Candidate& x, const Candidate& y) { return x.cost < y.cost; };
  for (const Superquadric& start : starts) candidates.push_back(fit(coarse, 0, start, 1));
  std::stable_sort(candidates.begin(), candidates.end(), cheaper);
  options.max_iterations = config.cut_iterations;
  // An outline that no whole shape explains is more likely to be cut.
  const double trust = std::pow(candidates[0].outline_share, 3);
  for (View& view : views) view.charge *= trust;
  const std::array bases{candidates[0].result.shape, candidates[1].result.shape};
  for (size_t view = 1; view < views.size(); ++view) {
    for (const Superquadric& base : bases) candidates.push_back(fit(coarse, view, base, 1));
  }
  std::stable_sort(candidates.begin(), candidates.end(), cheaper);

  options = {config.fine_iterations, config.fine_tolerance};
  std::vector<Candidate> best;
  for (size_t i = 0; i < 2; ++i) {
    if (i > 0 && candidates[i].cost > config.runner_up * candidates[0].cost) break;
    best.push_back(fit(fine, candidates[i].view, candidates[i].result.shape, candidates[i].outline_share));
  }
  std::stable_sort(best.begin(), best.end(), cheaper);
  if (getenv("BDBG")) {  // DEBUG
    const auto show = [&](const char* w, const Candidate& c, const PointBlock& pts) {
      const AdaptiveProblem problem(pts, views[c.view].rays, scene, UprightAxis(c.result.shape, table_F), config, views[c.view].cut);
      const AdaptiveCost k = problem.CostOf(c.result.shape);
      const auto& s = c.result.shape;
      printf("%s view %zu cost %.3f charge %.3f pts %.3f out %.3f sup %.3f tilt %.3f cut %.3f vol %.3f a %.3f %.3f %.3f e %.2f %.2f\n", w, c.view, c.cost*1e6, views[c.view].charge*1e6, k.points*1e6,k.outline*1e6,k.support*1e6,k.tilt*1e6,k.cut*1e6,k.volume*1e6,s.semi_axes[0],s.semi_axes[1],s.semi_axes[2],s.epsilon[0],s.epsilon[1]);
    };
    for (size_t v=1; v<views.size(); ++v) { const auto& s=silhouette.straights[v-1]; printf("view %zu: rays %zu of %d normal %.2f %.2f width %.3f beyond %.3f rms px %.2f\n", v, s.rays.size(), silhouette.rays_F.size, s.normal_F[0], s.normal_F[1], s.width_rad*distance, views[v].cut.beyond_m, std::sqrt(s.mean_square_rad)*525); }
    for (auto& c : candidates) show(" c", c, coarse);
    for (auto& c : best) show(" B", c, fine);
  }
  outcome.shape = best[0].result.shape;
  outcome.converged = best[0].result.converged;
  const bool other_shape = best.size() > 1 && MeanRadialDistance(best[1].result.shape, spread) <
                               kAboutAsGood * MeanRadialDistance(best[0].result.shape, spread) &&
                           ShapeDifference(best[0].result.shape, best[1].result.shape) > kOtherShape_m;
  // The cost is a mean of squared distances; neighbours err together, so that hundreds of points do not know
  // as much as if they were independent. How badly the outline fits tells how much else is not in the model.
  const double unexplained = 1 + best[0].outline_cost / config.outline_clean_m2;
  outcome.information =
      ParameterMatrix(best[0].result.at_minimum.hessian.selfadjointView<Eigen::Lower>()) *
      (config.witnesses / (unexplained * unexplained * std::max(best[0].points_cost, 4e-8)));
  outcome.ambiguous = other_shape || FootIsUnseen(outcome.shape, spread, scene, config.unseen_foot_m);
  return outcome;
}

}  // namespace beckon::pose
