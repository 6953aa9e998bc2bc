// A hierarchical RANSAC search for a superquadric with ranked voting.
#include "services/pose/fit_hierarchical.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "services/pose/principal_start.h"
#include "services/pose/seeded_draws.h"
#include "services/pose/solid.h"
#include "services/pose/solina_problem.h"
#include "services/pose/surface.h"

namespace beckon::pose {
namespace {

constexpr size_t kFewestPoints = 20;  // that a level or a sample must have, for 11 parameters

// What speaks for and against a hypothesis; less is better in each.
enum Criterion { kMissed, kError, kInside, kBulk, kCriteria };

struct Hypothesis {
  Superquadric shape;
  std::array<double, kCriteria> criteria{};
  double votes = 0;      // sum of its places, fewer are better
  bool at_rest = false;  // its last refinement converged
};

LmOptions Iterations(int most) {
  LmOptions options;
  options.max_iterations = most;
  options.relative_tolerance = 1e-4;
  return options;
}

FitBounds BoundsFor(const PointList& points, const Superquadric& start,
                    const HierarchicalConfig& config) {
  FitBounds bounds = BoundsByExtent(points, start, config.min_semi_axis_m, config.axis_margin_m);
  bounds.min_epsilon = config.min_epsilon;
  bounds.max_epsilon = config.max_epsilon;
  return bounds;
}

// Levels of ever more points, coarse to fine; those with too few are left out.
std::vector<PointList> Levels(const PointList& points, const HierarchicalConfig& config) {
  std::vector<PointList> levels;
  for (double voxel_m : config.voxels_m) {
    PointList level = VoxelCentroids(points, voxel_m);
    if (level.size() >= 2 * kFewestPoints) levels.push_back(std::move(level));
  }
  levels.push_back(Thinned(points, config.fine_points));
  return levels;
}

// Some of the points within a random distance of a random one; all where they are too few.
PointList DrawSample(const PointList& points, double radius_m, const HierarchicalConfig& config,
                     std::mt19937& engine) {
  const Eigen::Vector3d seed = points[DrawIndex(engine, points.size())];
  const double reach =
      2 * radius_m * (config.min_region + (1 - config.min_region) * DrawUnit(engine));
  PointList region;
  for (const auto& p : points) {
    if ((p - seed).squaredNorm() <= reach * reach) region.push_back(p);
  }
  if (region.size() < kFewestPoints) region = points;
  // The first of a shuffle (Fisher & Yates).
  const size_t count = std::min(region.size(), static_cast<size_t>(config.sample_points));
  for (size_t i = 0; i < count; ++i) {
    std::swap(region[i], region[i + DrawIndex(engine, region.size() - i)]);
  }
  region.resize(count);
  return region;
}

void Verify(const PointList& points, double inlier_m, Hypothesis& h) {
  int near = 0, inside = 0;
  double error = 0;
  for (const auto& p : points) {
    const Eigen::Vector3d p_O = h.shape.X_FO.inverse() * p;
    const double distance = RadialDistance(h.shape, p);
    error += std::min(distance, 3 * inlier_m);
    if (distance <= inlier_m) {
      ++near;
    } else if (Gauge(h.shape, p_O) < 1) {
      ++inside;
    }
  }
  const auto count = static_cast<double>(points.size());
  h.criteria[kMissed] = 1 - near / count;
  h.criteria[kError] = error / count;
  h.criteria[kInside] = inside / count;
  h.criteria[kBulk] = Volume(h.shape);
}

// Sorts the hypotheses by every criterion in turn and orders them by the sum of their places.
void RankByVotes(std::vector<Hypothesis>& hypotheses) {
  for (Hypothesis& h : hypotheses) h.votes = 0;
  for (int c = 0; c < kCriteria; ++c) {
    const auto less = [c](const Hypothesis& a, const Hypothesis& b) {
      return a.criteria[c] < b.criteria[c];
    };
    std::stable_sort(hypotheses.begin(), hypotheses.end(), less);
    // Equals share a place.
    size_t place = 0;
    for (size_t i = 0; i < hypotheses.size(); ++i) {
      if (i > 0 && less(hypotheses[i - 1], hypotheses[i])) place = i;
      hypotheses[i].votes += static_cast<double>(place);
    }
  }
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.votes < b.votes; });
}

std::vector<Hypothesis> DrawHypotheses(const PointList& points, const HierarchicalConfig& config) {
  std::mt19937 engine(static_cast<unsigned>(config.seed));
  const double radius_m = ComputePrincipalBox(points).half_extents.maxCoeff();
  std::vector<Hypothesis> hypotheses(static_cast<size_t>(config.hypotheses));
  for (size_t i = 0; i < hypotheses.size(); ++i) {
    const PointList sample = DrawSample(points, radius_m, config, engine);
    const Superquadric start =
        PrincipalEllipsoid(ComputePrincipalBox(sample), static_cast<int>(i % 3));
    hypotheses[i].shape = Minimise(SolinaProblem(sample), start, BoundsFor(points, start, config),
                                   Iterations(config.sample_iterations))
                              .shape;
    Verify(points, config.inlier_m, hypotheses[i]);
  }
  RankByVotes(hypotheses);
  return hypotheses;
}

size_t Kept(size_t count, double part) {
  return std::clamp<size_t>(static_cast<size_t>(std::ceil(part * static_cast<double>(count))), 1,
                            count);
}

}  // namespace

MethodOutcome FitHierarchical(const PointList& points_F, const HierarchicalConfig& config) {
  const std::vector<PointList> levels = Levels(points_F, config);
  std::vector<Hypothesis> hypotheses = DrawHypotheses(levels[0], config);
  MethodOutcome outcome;
  for (const PointList& level : levels) {
    const bool last = &level == &levels.back();
    const LmOptions options = Iterations(last ? config.fine_iterations : config.level_iterations);
    hypotheses.resize(Kept(hypotheses.size(), config.keep));
    int iterations = 0;
    for (Hypothesis& h : hypotheses) {
      const LmResult refined =
          Minimise(SolinaProblem(level), h.shape, BoundsFor(level, h.shape, config), options);
      iterations += refined.iterations;
      h.shape = refined.shape;
      h.at_rest = refined.converged;
      Verify(level, config.inlier_m, h);
    }
    RankByVotes(hypotheses);
    outcome.iterations.push_back(iterations);
  }
  outcome.shape = hypotheses[0].shape;
  outcome.converged = hypotheses[0].at_rest;
  return outcome;
}

}  // namespace beckon::pose
