// The multi-scale superquadric fit of Duncan et al. (ICRA 2013).
#include "services/pose/fit_multiscale.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/pose/principal_start.h"
#include "services/pose/smoothing.h"
#include "services/pose/solina_problem.h"
#include "services/pose/surface.h"

namespace beckon::pose {
namespace {

constexpr size_t kFewestPoints = 20;  // that a level must have, for 11 parameters

constexpr int kMostSmoothed = 5000;  // points; the time of smoothing grows with their square
constexpr double kStopLevel = 1e-4;  // relative gain of a step that ends a level

struct Candidate {
  LmResult last;
  std::vector<int> iterations;  // per level
  double error = 0;             // mean radial distance of all points, m
};

// Runs the levels from one start. A level whose grid leaves too few points to determine the shape
// is passed over.
Candidate FitLevels(const std::vector<PointList>& levels, const Superquadric& start,
                    const MultiscaleConfig& config) {
  FitBounds bounds =
      BoundsByExtent(levels.back(), start, config.min_semi_axis_m, config.axis_margin_m);
  bounds.min_epsilon = config.min_epsilon;
  bounds.max_epsilon = config.max_epsilon;
  bounds.max_taper = config.max_taper;
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
  const PointList points =
      config.smooth_m > 0
          ? SmoothedByMovingLeastSquares(Thinned(points_F, kMostSmoothed), config.smooth_m)
          : points_F;
  std::vector<PointList> levels;
  for (double voxel_m : config.voxels_m) levels.push_back(VoxelCentroids(points, voxel_m));
  levels.push_back(points);

  const PrincipalBox box = ComputePrincipalBox(points);
  std::vector<Candidate> candidates;
  for (int z_axis = 0; z_axis < 3; ++z_axis) {
    candidates.push_back(FitLevels(levels, PrincipalEllipsoid(box, z_axis), config));
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.error < b.error; });

  const Candidate& best = candidates[0];
  MethodOutcome outcome{best.last.shape, best.last.converged, false, best.iterations, {}, {}};
  for (size_t i = 1; i < candidates.size(); ++i) {
    outcome.ambiguous |= candidates[i].error < kAboutAsGood * best.error &&
                         ShapeDifference(candidates[i].last.shape, best.last.shape) > kOtherShape_m;
  }
  return outcome;
}

}  // namespace beckon::pose
