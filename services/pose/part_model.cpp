// An object as a union of superquadrics: how well it explains points, and its refit.
#include "services/pose/part_model.h"

#include <algorithm>
#include <cmath>

namespace beckon::pose {
namespace {

constexpr int kSearchSteps = 12;       // of the deepest points of rays
constexpr double kRayReach_m = 0.015;  // rays that pass all parts farther away belong to none
constexpr double kLooseGrowth = 1.6;   // a semi-axis grows to this many times its start at most

// `subset` of a block with weights that sum to 1.
template <typename Keep>
PointBlock Subset(const PointBlock& block, const Keep& keep) {
  PointBlock subset;
  for (int i = 0; i < block.size; ++i) {
    if (keep(i)) subset.Add(block.at(i), 1);
  }
  for (int i = 0; i < subset.size; ++i) {
    subset.weight[static_cast<size_t>(i)] = 1 / static_cast<float>(subset.size);
  }
  if (subset.size > 0) subset.Pad();
  return subset;
}

// How far the rays pass from the shape, signed.
void RayDistances(const Superquadric& shape, const PartsView& view, BlockDistances& distances_m) {
  PointBlock deepest;
  FindDeepest(shape, view.scene.viewpoint, view.rays_F, kSearchSteps, deepest);
  ComputeDistances(shape, deepest, distances_m);
}

FitBounds BoundsOf(const Superquadric& start, const AdaptiveConfig& fit, double min_semi_axis_m) {
  FitBounds bounds;
  bounds.min_axes.setConstant(min_semi_axis_m);
  bounds.max_axes = (start.semi_axes * kLooseGrowth).cwiseMax(min_semi_axis_m);
  bounds.min_epsilon = fit.min_epsilon;
  bounds.max_epsilon = fit.max_epsilon;
  return bounds;
}

}  // namespace

float PartModel::DistanceOf(int i) const {
  float least = distances_m[0][static_cast<size_t>(i)];
  for (const BlockDistances& d : distances_m) least = std::min(least, d[static_cast<size_t>(i)]);
  return least;
}

size_t PartModel::Nearest(int i) const {
  const size_t k = static_cast<size_t>(i);
  size_t nearest = 0;
  for (size_t part = 1; part < distances_m.size(); ++part) {
    if (std::abs(distances_m[part][k]) < std::abs(distances_m[nearest][k])) nearest = part;
  }
  return nearest;
}

PartModel Judge(std::vector<Superquadric> parts, const PartsView& view, double foreign_m) {
  PartModel model;
  model.parts = std::move(parts);
  model.distances_m.resize(model.parts.size());
  for (size_t part = 0; part < model.parts.size(); ++part) {
    ComputeDistances(model.parts[part], view.points_F, model.distances_m[part]);
  }
  model.variance_m2 = Variance(model, view, foreign_m);
  return model;
}

double Variance(const PartModel& model, const PartsView& view, double foreign_m) {
  double squares = 0;
  for (int i = 0; i < view.points_F.size; ++i) {
    const double d = std::min(std::abs(static_cast<double>(model.DistanceOf(i))), foreign_m);
    squares += d * d;
  }
  return view.noise_m * view.noise_m + squares / std::max(view.points_F.size, 1);
}

std::vector<bool> SeenThrough(const Superquadric& shape, const Eigen::Vector3d& viewpoint_F,
                              const PointBlock& points_F, double depth_m) {
  PointBlock rays, deepest;
  for (int i = 0; i < points_F.size; ++i) {
    rays.Add((points_F.at(i) - viewpoint_F).normalized(), 1);
  }
  if (rays.size > 0) rays.Pad();
  FindDeepest(shape, viewpoint_F, rays, kSearchSteps, deepest);
  BlockDistances depth;
  ComputeDistances(shape, deepest, depth);
  std::vector<bool> through(static_cast<size_t>(points_F.size));
  for (int i = 0; i < points_F.size; ++i) {
    const bool before =
        (deepest.at(i) - viewpoint_F).norm() < (points_F.at(i) - viewpoint_F).norm();
    through[static_cast<size_t>(i)] =
        before && static_cast<double>(depth[static_cast<size_t>(i)]) < -depth_m;
  }
  return through;
}

std::vector<Superquadric> Refit(const PartModel& model, const PartsView& view,
                                const AdaptiveConfig& fit, int iterations, double min_semi_axis_m) {
  std::vector<BlockDistances> ray_distances(model.parts.size());
  for (size_t part = 0; part < model.parts.size(); ++part) {
    RayDistances(model.parts[part], view, ray_distances[part]);
  }
  const auto ray_of = [&](size_t part, int i) {
    const size_t k = static_cast<size_t>(i);
    const float own = std::abs(ray_distances[part][k]);
    if (static_cast<double>(own) > kRayReach_m) return false;
    return std::all_of(ray_distances.begin(), ray_distances.end(),
                       [&](const BlockDistances& d) { return std::abs(d[k]) >= own; });
  };
  std::vector<Superquadric> refitted = model.parts;
  AdaptiveConfig loose = fit;
  loose.support_weight = loose.proportion_prior_m2 = 0;  // handles and necks are thin
  for (size_t part = 0; part < refitted.size(); ++part) {
    Superquadric& shape = refitted[part];
    // Of the main body's many points half will do.
    const PointBlock points = Subset(
        view.points_F, [&](int i) { return (part > 0 || i % 2 == 0) && model.Nearest(i) == part; });
    if (points.size < kParameters) continue;
    const PointBlock rays = Subset(view.rays_F, [&](int i) { return ray_of(part, i); });
    AdaptiveProblem problem(points, rays, view.scene, UprightAxis(shape, view.scene.table),
                            part == 0 ? fit : loose);
    problem.set_search_steps(kSearchSteps);
    shape =
        Minimise(problem, shape, BoundsOf(shape, fit, min_semi_axis_m), {iterations, 1e-4}).shape;
  }
  return refitted;
}

Superquadric FitLoosePart(const PointBlock& points_F, const PartsView& view,
                          const Superquadric& start, const AdaptiveConfig& fit, int iterations,
                          double min_semi_axis_m) {
  AdaptiveConfig loose = fit;
  loose.support_weight = loose.proportion_prior_m2 = 0;  // handles and necks are thin
  PointBlock none;
  const AdaptiveProblem problem(points_F, none, view.scene, UprightAxis(start, view.scene.table),
                                loose);
  return Minimise(problem, start, BoundsOf(start, fit, min_semi_axis_m), {iterations, 1e-4}).shape;
}

}  // namespace beckon::pose
