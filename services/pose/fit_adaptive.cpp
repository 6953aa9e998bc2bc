// The default fit: several starts, a robust distance to the surface, and what a table-top scene
// knows.
#include "services/pose/fit_adaptive.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/pose/adaptive_problem.h"
#include "services/pose/even_spread.h"
#include "services/pose/silhouette.h"
#include "services/pose/starts.h"
#include "services/pose/surface.h"
#include "services/pose/visibility.h"

namespace beckon::pose {
namespace {

constexpr int kCoarseSteps = 9, kFineSteps = 13;  // of the search for a ray's deepest point
constexpr double kCoarseTolerance = 1e-3;
constexpr double kLeastVariance_m2 = 4e-8;

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

// Every third ray, for coarse fits.
PointBlock EveryThird(const PointBlock& block) {
  PointBlock third;
  for (int i = 0; i < block.size; i += 3) {
    third.Add(block.at(i), 3.0 * static_cast<double>(block.weight[static_cast<size_t>(i)]));
  }
  third.Pad();
  return third;
}

// The outline as it is taken to be: whole, or cut off on a side.
struct View {
  PointBlock rays, few_rays;
  std::vector<Cut> cuts = {};
  bool is_guess = false;  // nobody knows whether there is a cut
  double charge = 0;      // m^2, for the cut's improbability
  double ragged = 0;      // m^2, what the cut's rays cost about their own straight line
};

View WholeView(const Silhouette& silhouette) {
  return {silhouette.rays_F, EveryThird(silhouette.rays_F)};
}

// `distance_m`: of the object from the viewpoint.
Cut CutBehind(const Straight& straight, double distance_m, const AdaptiveConfig& config) {
  const double width_m = straight.width_rad * distance_m;
  return {straight.normal_F, config.cut_beyond * width_m,
          std::max(config.cut_sigma * width_m, 1e-3)};
}

View CutView(const Silhouette& silhouette, const Straight& straight, double distance_m,
             const AdaptiveConfig& config) {
  View view{silhouette.rays_F, {}};
  view.cuts.push_back(CutBehind(straight, distance_m, config));
  view.is_guess = true;
  const double scale2 = config.outline_noise_m * config.outline_noise_m;
  const double ragged = straight.mean_square_rad * distance_m * distance_m;
  const double cost_of_ray = config.outline_weight * scale2 * std::log1p(ragged / scale2);
  for (int i : straight.rays) {
    float& weight = view.rays.weight[static_cast<size_t>(i)];
    view.ragged += static_cast<double>(std::exchange(weight, 0.0f)) * cost_of_ray;
  }
  view.few_rays = EveryThird(view.rays);
  return view;
}

// A shape that was fitted under one view.
struct Candidate {
  LmResult result;
  const View* view;
  AdaptiveCost cost;
  double outline_share;  // what the outline is worth: 1 where it fits, less the worse it does
  double score;          // m^2; the least wins
};

bool Better(const Candidate& a, const Candidate& b) { return a.score < b.score; }

// Whether two shapes are clearly not the same, told from their numbers alone.
bool LookDifferent(const Superquadric& a, const Superquadric& b) {
  constexpr double kMove_m = 0.004, kGrowth = 0.1;
  const double moved = (a.X_FO.translation() - b.X_FO.translation()).norm();
  const double grown = std::abs(std::log(a.semi_axes.prod() / b.semi_axes.prod()));
  return moved > kMove_m || grown > kGrowth;
}

// One object's fit: what all its stages use.
class Fitter {
 public:
  Fitter(const SpreadPoints& spread, const Superquadric& filling, const TableTopScene& scene,
         const AdaptiveConfig& config)
      : fine_(Block(spread, kBlockSize)),
        coarse_(Block(spread, config.coarse_points)),
        scene_(scene),
        config_(config) {
    const double reach = filling.semi_axes.maxCoeff();
    bounds_.min_axes.setConstant(config.min_semi_axis_m);
    bounds_.max_axes.setConstant(
        std::max(reach * (1 + config.axis_margin), config.min_semi_axis_m));
    bounds_.min_epsilon = config.min_epsilon;
    bounds_.max_epsilon = config.max_epsilon;
  }

  Candidate FitCoarsely(const Superquadric& start, const View& view, int iterations) {
    return FitTo(coarse_, view.few_rays, kCoarseSteps, start, view, 1,
                 {iterations, kCoarseTolerance});
  }
  Candidate Refine(const Candidate& c) {
    return FitTo(fine_, c.view->rays, kFineSteps, c.result.shape, *c.view, c.outline_share,
                 {config_.fine_iterations, config_.fine_tolerance});
  }
  const std::vector<int>& iterations() const { return iterations_; }

 private:
  // The noise of the outline is not known, so its cost counts by the logarithm, as if its scale had
  // been estimated with it; the minimisation takes the slope of that, outline_share, from the stage
  // before.
  Candidate FitTo(const PointBlock& points, const PointBlock& rays, int steps,
                  const Superquadric& start, const View& view, double outline_share,
                  const LmOptions& options) {
    AdaptiveProblem problem(points, rays, scene_, UprightAxis(start, scene_.table), config_,
                            view.cuts);
    problem.set_search_steps(steps);
    problem.set_outline_share(outline_share);
    Candidate c{Minimise(problem, start, bounds_, options), &view, {}, 1, 0};
    iterations_.push_back(c.result.iterations);
    problem.set_outline_share(1);
    c.cost = problem.CostOf(c.result.shape);
    const double outline = (c.cost.outline + view.ragged) / config_.outline_trust_m2;
    c.outline_share = 1 / (1 + outline);
    c.score = c.cost.points + c.cost.support + c.cost.tilt + c.cost.top + c.cost.volume +
              c.cost.proportion + config_.outline_trust_m2 * std::log1p(outline) + view.charge;
    return c;
  }

  const PointBlock fine_, coarse_;
  const TableTopScene& scene_;
  const AdaptiveConfig& config_;
  FitBounds bounds_;
  std::vector<int> iterations_;
};

// The outline as it is seen, then, where nobody knows what lies beyond the outline,
// what may be cuts.
std::vector<View> ViewsOf(const Silhouette& silhouette, double distance_m,
                          const AdaptiveConfig& config) {
  std::vector<View> views;
  views.push_back(WholeView(silhouette));
  for (const Straight& s : silhouette.cuts) {
    views[0].cuts.push_back(CutBehind(s, distance_m, config));
  }
  if (!config.cut_hypotheses) return views;
  double straightest_rad2 = 1;
  for (const Straight& s : silhouette.straights) {
    straightest_rad2 = std::min(straightest_rad2, s.mean_square_rad);
  }
  for (const Straight& s : silhouette.straights) {
    views.push_back(CutView(silhouette, s, distance_m, config));
    views.back().charge = config.cut_ragged_m2 * (s.mean_square_rad - straightest_rad2) /
                          (config.pixel_rad * config.pixel_rad);
  }
  return views;
}

// Coarse fits from all starts under the first view, and from the best two under the others; best
// first.
std::vector<Candidate> Explore(Fitter& fitter, const std::vector<Superquadric>& starts,
                               std::vector<View>& views, const AdaptiveConfig& config) {
  std::vector<Candidate> candidates;
  for (const Superquadric& start : starts) {
    candidates.push_back(fitter.FitCoarsely(start, views[0], config.coarse_iterations));
  }
  std::stable_sort(candidates.begin(), candidates.end(), Better);
  // An outline that no whole shape explains is more likely to be cut.
  const double charge_share = std::pow(candidates[0].outline_share, 3);
  const Superquadric bases[2] = {candidates[0].result.shape, candidates[1].result.shape};
  for (size_t i = 1; i < views.size(); ++i) {
    views[i].charge += charge_share * config.cut_charge_m2;
    for (const Superquadric& base : bases) {
      candidates.push_back(fitter.FitCoarsely(base, views[i], config.cut_iterations));
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(), Better);
  return candidates;
}

// The best candidate to all points, the next that is of another shape if it is about as good, and
// where the best is cut off the best that is whole: a coarse fit does not go on behind a cut far
// enough to be compared. Best first.
std::vector<Candidate> RefineBest(Fitter& fitter, const std::vector<Candidate>& candidates,
                                  double runner_up) {
  std::vector<Candidate> refined{fitter.Refine(candidates[0])};
  for (size_t i = 1; i < candidates.size(); ++i) {
    if (candidates[i].score > runner_up * candidates[0].score) break;
    if (!LookDifferent(candidates[0].result.shape, candidates[i].result.shape)) continue;
    refined.push_back(fitter.Refine(candidates[i]));
    break;
  }
  if (candidates[0].view->is_guess) {
    const auto whole = std::find_if(candidates.begin(), candidates.end(),
                                    [](const Candidate& c) { return !c.view->is_guess; });
    if (whole != candidates.end()) refined.push_back(fitter.Refine(*whole));
  }
  std::stable_sort(refined.begin(), refined.end(), Better);
  return refined;
}

// The Hessian of the cost, a mean of squares, in units of information: neighbours err together, so
// that hundreds of points do not know as much as if they were independent, and how badly the
// outline fits tells how much else is not in the model. Where points are so few that none is left
// out, the outermost lie well within the outline, and the fit errs by more than their number tells.
ParameterMatrix InformationOf(const Candidate& c, size_t n_points, const AdaptiveConfig& config) {
  const double unexplained = 1 + c.cost.outline / config.outline_clean_m2;
  const double enough = std::min(static_cast<double>(n_points) / config.fine_points, 1.0);
  const double witnesses = config.witnesses * std::pow(enough, 4);
  const double variance = unexplained * unexplained * std::max(c.cost.points, kLeastVariance_m2);
  return ParameterMatrix(c.result.at_minimum.hessian.selfadjointView<Eigen::Lower>()) *
         (witnesses / variance);
}

}  // namespace

MethodOutcome FitAdaptive(const PointList& points_F, const std::optional<Plane>& table_F,
                          const Eigen::Vector3d& viewpoint_F, std::span<const RimPoint> rim_F,
                          const AdaptiveConfig& config) {
  const SpreadPoints spread = SpreadEvenly(points_F, config.fine_points);
  const std::vector<Superquadric> starts = Starts(spread.points, table_F);
  TableTopScene scene{table_F, viewpoint_F, starts[0].semi_axes.array().log().sum()};
  if (table_F) scene.top_m = SeenTop(spread, *table_F);
  const Silhouette silhouette =
      TraceSilhouette(points_F, rim_F, viewpoint_F, table_F,
                      {config.outline_rays, config.pixel_rad, config.table_margin_m});
  const double distance_m = (starts[0].X_FO.translation() - viewpoint_F).norm();
  std::vector<View> views = ViewsOf(silhouette, distance_m, config);

  Fitter fitter(spread, starts[0], scene, config);
  const std::vector<Candidate> refined =
      RefineBest(fitter, Explore(fitter, starts, views, config), config.runner_up);
  const Candidate& best = refined[0];

  MethodOutcome outcome;
  outcome.shape = best.result.shape;
  outcome.converged = best.result.converged;
  outcome.iterations = fitter.iterations();
  outcome.information = InformationOf(best, points_F.size(), config);
  for (size_t i = 1; i < refined.size(); ++i) {
    const Superquadric& other = refined[i].result.shape;
    if (refined[i].score < kAboutAsGood * best.score &&
        ShapeDifference(best.result.shape, other) > kOtherShape_m) {
      outcome.alternatives.push_back(other);
    }
  }
  // How far it goes on behind a cut is a guess.
  outcome.ambiguous = !outcome.alternatives.empty() || !best.view->cuts.empty() ||
                      (table_F && FootIsUnseen(outcome.shape, spread.points, *table_F, viewpoint_F,
                                               config.unseen_foot_m));
  return outcome;
}

}  // namespace beckon::pose
