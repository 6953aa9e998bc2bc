// The default fit: several starts, a robust distance to the surface, and what a table-top scene
// knows.
#include "services/pose/fit_adaptive.h"

#include <algorithm>
#include <cmath>

#include "services/pose/distance_kernel.h"
#include "services/pose/silhouette.h"
#include "services/pose/starts.h"
#include "services/pose/surface.h"

namespace beckon::pose {
namespace {

constexpr int kPointsForSize = 300;

// s^2 log(1 + (r/s)^2) and its weight (Cauchy; Zhang 1997, table 1).
struct Robust {
  double cost, weight;
};
Robust Cauchy(double residual, double scale) {
  const double x = residual * residual / (scale * scale);
  return {scale * scale * std::log(1 + x), 1 / (1 + x)};
}

// What does not change between the stages of one fit.
struct Scene {
  std::optional<Plane> table;
  Eigen::Vector3d viewpoint;
};

class AdaptiveProblem : public FitProblem {
 public:
  /// `upright` is the axis of the shape that is to be vertical.
  AdaptiveProblem(const PointBlock& points, const PointBlock& rays, const Scene& scene, int upright,
                  const AdaptiveConfig& config)
      : points_(points), rays_(rays), scene_(scene), upright_(upright), config_(config) {}

  NormalEquations Linearise(const Superquadric& shape) const override {
    NormalEquations eq;
    DistanceSum sum = SumDistances(shape, points_, {config_.noise_m, config_.noise_m});
    AddKernel(shape, sum, 1.0, eq);
    if (rays_.size > 0) {
      PointBlock deepest;
      FindDeepest(shape, scene_.viewpoint, rays_, deepest);
      sum = SumDistances(shape, deepest, {config_.outline_noise_m, config_.outline_outside_m});
      AddKernel(shape, sum, config_.outline_weight, eq);
    }
    if (scene_.table) {
      AddSupport(shape, eq);
      AddTilt(shape, eq);
    }
    eq.cost += config_.volume_prior_m2 * shape.semi_axes.array().log().sum();
    eq.gradient.segment<3>(kLogAxes).array() += 0.5 * config_.volume_prior_m2;
    return eq;
  }

 private:
  // The kernel's derivatives by rotation and translation are in O.
  static void AddKernel(const Superquadric& shape, const DistanceSum& sum, double weight,
                        NormalEquations& eq) {
    Eigen::Matrix<double, kKernelParameters, kKernelParameters> turn;
    turn.setIdentity();
    turn.block<3, 3>(kRotation, kRotation) = shape.X_FO.linear();
    turn.block<3, 3>(kTranslation, kTranslation) = shape.X_FO.linear();
    eq.cost += weight * sum.cost;
    eq.gradient.head<kKernelParameters>() += weight * (turn * sum.gradient);
    eq.hessian.topLeftCorner<kKernelParameters, kKernelParameters>() +=
        weight * (turn * sum.hessian * turn.transpose());
  }

  // max of n·p over the shape, with its derivatives by the parameters.
  static double Reach(const Superquadric& shape, const Eigen::Vector3d& n_F,
                      ParameterVector& jacobian) {
    const Eigen::Matrix3d& R = shape.X_FO.linear();
    const SupportDerivatives d = DifferentiateSupport(shape, R.transpose() * n_F);
    jacobian.setZero();
    jacobian.segment<3>(kLogAxes) = d.log_semi_axes;
    jacobian.segment<2>(kEpsilon) = d.epsilon;
    jacobian.segment<3>(kRotation) = (R * d.point).cross(n_F);
    jacobian.segment<3>(kTranslation) = n_F;
    return n_F.dot(shape.X_FO.translation()) + d.h;
  }

  // The lowest point lies on the table: max over the shape of -n·p equals the plane's offset.
  void AddSupport(const Superquadric& shape, NormalEquations& eq) const {
    ParameterVector jacobian;
    const double below = Reach(shape, -scene_.table->normal, jacobian) - scene_.table->offset_m;
    const Robust robust = Cauchy(below, config_.support_noise_m);
    eq.Add(below, jacobian, config_.support_weight * robust.weight);
    eq.cost += config_.support_weight * robust.cost;
  }

  // The upright axis has no horizontal components.
  void AddTilt(const Superquadric& shape, NormalEquations& eq) const {
    const Eigen::Vector3d axis = shape.X_FO.linear().col(upright_);
    const Eigen::Vector3d right = scene_.table->normal.unitOrthogonal();
    for (const Eigen::Vector3d& h : {right, Eigen::Vector3d(scene_.table->normal.cross(right))}) {
      ParameterVector jacobian = ParameterVector::Zero();
      jacobian.segment<3>(kRotation) = axis.cross(h);
      const double lean = h.dot(axis);
      eq.Add(lean, jacobian, config_.tilt_weight);
      eq.cost += config_.tilt_weight * lean * lean;
    }
  }

  const PointBlock& points_;
  const PointBlock& rays_;
  const Scene& scene_;
  const int upright_;
  const AdaptiveConfig& config_;
};

// The axis of the shape nearest to the table's normal; 2 where there is no table.
int UprightAxis(const Superquadric& shape, const std::optional<Plane>& table) {
  int axis = 2;
  if (table) (shape.X_FO.linear().transpose() * table->normal).cwiseAbs().maxCoeff(&axis);
  return axis;
}

// About `count` points evenly spread over the surface: the centroids of a voxel grid of fitting
// size, which is found on a part of the points.
PointList EvenlySpread(const PointList& points, int count, double size_m) {
  if (points.size() <= static_cast<size_t>(count)) return points;
  double voxel_m = size_m / std::sqrt(static_cast<double>(count));
  const PointList part = Thinned(points, 4 * count);
  for (int tries = 0; tries < 3; ++tries) {
    const double ratio = static_cast<double>(VoxelCentroids(part, voxel_m).size()) / count;
    if (ratio > 0.8 && ratio < 1.25) break;
    voxel_m *= std::sqrt(ratio);  // points lie on a surface
  }
  return VoxelCentroids(points, voxel_m);
}

// Every so manieth of the points, at most `most`, of equal weight, 1 together.
PointBlock Block(const PointList& points, int most) {
  PointBlock block;
  const PointList part = Thinned(points, std::min(most, kBlockSize));
  for (const auto& p : part) block.Add(p, 1.0 / static_cast<double>(part.size()));
  block.Pad();
  return block;
}

// Whether the side of the shape that faces the camera reaches `gap_m` lower than the points do: its
// foot is hidden behind another object, or it stands on one, and how far down it goes is not known.
bool FootIsUnseen(const Superquadric& shape, const PointList& points, const Scene& scene,
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
                          const Eigen::Vector3d& viewpoint_F, const AdaptiveConfig& config) {
  const double size =
      ComputePrincipalBox(Thinned(points_F, kPointsForSize)).half_extents.maxCoeff();
  const PointList spread = EvenlySpread(points_F, config.fine_points, 2 * size);
  const std::vector<Superquadric> starts = Starts(spread, table_F);
  const double reach = starts[0].semi_axes.maxCoeff();
  const PointBlock fine = Block(spread, kBlockSize), coarse = Block(spread, config.coarse_points);
  const Scene scene{table_F, viewpoint_F};
  const Silhouette silhouette =
      TraceSilhouette(points_F, {}, viewpoint_F, table_F,
                      {config.outline_rays, config.pixel_rad, config.table_margin_m});
  FitBounds bounds;
  bounds.min_axes.setConstant(config.min_semi_axis_m);
  bounds.max_axes.setConstant(std::max(reach * (1 + config.axis_margin), config.min_semi_axis_m));
  bounds.min_epsilon = config.min_epsilon;
  bounds.max_epsilon = config.max_epsilon;

  MethodOutcome outcome;
  LmOptions options{config.coarse_iterations, 1e-3};
  std::vector<Superquadric> fits;
  std::vector<std::pair<double, size_t>> order;
  const auto judge = [&](const Superquadric& shape) {
    const AdaptiveProblem whole(coarse, silhouette.rays_F, scene, UprightAxis(shape, table_F), config);
    order.emplace_back(whole.Linearise(shape).cost, fits.size());
    fits.push_back(shape);
  };
  for (const Superquadric& start : starts) {
    const AdaptiveProblem problem(coarse, silhouette.rays_F, scene, UprightAxis(start, table_F), config);
    const LmResult fit = Minimise(problem, start, bounds, options);
    outcome.iterations.push_back(fit.iterations);
    judge(fit.shape);
  }
  std::sort(order.begin(), order.end());
  if (config.cut_hypotheses) {
    const size_t bases[2] = {order[0].second, order[1].second};
    for (const std::vector<int>& straight : silhouette.straights) {
      PointBlock rays = silhouette.rays_F;
      for (int i : straight) rays.weight[static_cast<size_t>(i)] = 0;
      for (size_t base : bases) {
        const AdaptiveProblem problem(coarse, rays, scene, UprightAxis(fits[base], table_F), config);
        const LmResult fit = Minimise(problem, fits[base], bounds, {config.cut_iterations, 1e-3});
        outcome.iterations.push_back(fit.iterations);
        judge(fit.shape);
      }
    }
    std::sort(order.begin(), order.end());
  }

  options = {config.fine_iterations, 1e-4};
  std::vector<LmResult> best;
  for (int i = 0; i < 2; ++i) {
    const Superquadric& start = fits[order[static_cast<size_t>(i)].second];
    const AdaptiveProblem problem(fine, silhouette.rays_F, scene, UprightAxis(start, table_F), config);
    best.push_back(Minimise(problem, start, bounds, options));
    outcome.iterations.push_back(best.back().iterations);
  }
  if (best[1].at_minimum.cost < best[0].at_minimum.cost) std::swap(best[0], best[1]);
  outcome.shape = best[0].shape;
  outcome.converged = best[0].converged;
  const bool other_shape = MeanRadialDistance(best[1].shape, spread) <
                               kAboutAsGood * MeanRadialDistance(best[0].shape, spread) &&
                           ShapeDifference(best[0].shape, best[1].shape) > kOtherShape_m;
  outcome.ambiguous = other_shape || FootIsUnseen(outcome.shape, spread, scene, config.unseen_foot_m);
  return outcome;
}

}  // namespace beckon::pose
