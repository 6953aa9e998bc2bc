// The multi-scale superquadric fit of Duncan et al. (ICRA 2013).
#include "services/pose/fit_multiscale.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/pose/surface.h"

namespace beckon::pose {
namespace {

constexpr size_t kFewestPoints = 20;  // that a level must have, for 11 parameters

constexpr double kStopLevel = 1e-4;  // relative gain of a step that ends a level

// Mean of [sqrt(a1 a2 a3) (F^e1 - 1)]^2 (Solina & Bajcsy 1990, eq. 17); F^e1 = g^2.
class SolinaProblem : public FitProblem {
 public:
  explicit SolinaProblem(const PointList& points) : points_(points) {}

  NormalEquations Linearise(const Superquadric& shape) const override {
    const double root_volume = std::sqrt(shape.semi_axes.prod());
    const double weight = 1.0 / static_cast<double>(points_.size());
    NormalEquations eq;
    ParameterVector jacobian;
    for (const auto& p : points_) {
      const Eigen::Vector3d arm_F = p - shape.X_FO.translation();
      const GaugeDerivatives d = DifferentiateGauge(shape, shape.X_FO.linear().transpose() * arm_F);
      const double g2 = std::exp(2 * d.log_g);
      const double residual = root_volume * (g2 - 1);
      const double scale = 2 * root_volume * g2;
      FillJacobian(shape, arm_F, d, scale, scale, jacobian);
      jacobian.segment<3>(kLogAxes).array() += 0.5 * residual;
      eq.Add(residual, jacobian, weight);
      eq.cost += weight * residual * residual;
    }
    return eq;
  }

 private:
  const PointList& points_;
};

// The ellipsoid that fills the points' box, with principal axis `z_axis` as z; the other two follow
// in turn.
Superquadric StartFrom(const PrincipalBox& box, int z_axis) {
  Superquadric start;
  for (int i = 0; i < 3; ++i) {
    const int from = (z_axis + 1 + i) % 3;
    start.X_FO.linear().col(i) = box.axes.col(from);
    start.semi_axes[i] = box.half_extents[from];
  }
  start.X_FO.translation() = box.centroid;
  return start;
}

FitBounds BoundsFor(const Superquadric& start, const MultiscaleConfig& config) {
  FitBounds bounds;
  bounds.min_axes.setConstant(config.min_semi_axis_m);
  bounds.max_axes = (start.semi_axes.array() + config.axis_margin_m).max(config.min_semi_axis_m);
  bounds.min_epsilon = config.min_epsilon;
  bounds.max_epsilon = config.max_epsilon;
  bounds.max_taper = config.max_taper;
  return bounds;
}

struct Candidate {
  LmResult last;
  std::vector<int> iterations;  // per level
  double error = 0;             // mean radial distance of all points, m
};

// Runs the levels from one start. A level whose grid leaves too few points to determine the shape
// is passed over.
Candidate FitLevels(const std::vector<PointList>& levels, const Superquadric& start,
                    const MultiscaleConfig& config) {
  const FitBounds bounds = BoundsFor(start, config);
  LmOptions options;
  options.max_iterations = config.max_iterations;
  options.relative_tolerance = kStopLevel;
  const PointList& all = levels.back();
  Candidate candidate;
  candidate.last.shape = start;
  candidate.error = MeanRadialDistance(start, all);
  for (const PointList& level : levels) {
    if (level.size() < kFewestPoints && &level != &all) continue;
    candidate.last = Minimise(SolinaProblem(level), candidate.last.shape, bounds, options);
    candidate.iterations.push_back(candidate.last.iterations);
    const double before =
        std::exchange(candidate.error, MeanRadialDistance(candidate.last.shape, all));
    if (candidate.iterations.size() > 1 &&
        std::abs(before - candidate.error) < config.stop_change * before) {
      candidate.last.converged = true;
      break;
    }
  }
  return candidate;
}

}  // namespace

MethodOutcome FitMultiscale(const PointList& points_F, const MultiscaleConfig& config) {
  std::vector<PointList> levels;
  for (double voxel_m : config.voxels_m) levels.push_back(VoxelCentroids(points_F, voxel_m));
  levels.push_back(points_F);

  const PrincipalBox box = ComputePrincipalBox(points_F);
  std::vector<Candidate> candidates;
  for (int z_axis = 0; z_axis < 3; ++z_axis) {
    candidates.push_back(FitLevels(levels, StartFrom(box, z_axis), config));
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.error < b.error; });

  const Candidate& best = candidates[0];
  MethodOutcome outcome{best.last.shape, best.last.converged, false, best.iterations};
  for (size_t i = 1; i < candidates.size(); ++i) {
    outcome.ambiguous |= candidates[i].error < kAboutAsGood * best.error &&
                         ShapeDifference(candidates[i].last.shape, best.last.shape) > kOtherShape_m;
  }
  return outcome;
}

}  // namespace beckon::pose
