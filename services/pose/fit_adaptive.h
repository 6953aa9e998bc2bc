// The default fit: several starts, a robust distance to the surface, and what a table-top scene
// knows.
#pragma once

#include <optional>
#include <span>

#include "services/base/geometry.h"
#include "services/base/rim.h"
#include "services/pose/fit_stage.h"

namespace beckon::pose {

struct AdaptiveConfig {
  // The starts are fitted to about coarse_points, the best two of them to fine_points.
  int coarse_points = 60;
  int fine_points = 300;
  int coarse_iterations = 6;
  int fine_iterations = 50;
  double noise_m = 0.002;  // scale of the Cauchy weights of points
  double min_semi_axis_m = 0.005;
  // A semi-axis is at most 1 + this times the points' largest half extent.
  double axis_margin = 1.0;
  double min_epsilon = 0.1;
  double max_epsilon = 1.0;
  double volume_prior_m2 = 5e-7;  // times log volume: of two shapes that fit as well, the smaller
  // What the table adds.
  double support_weight = 1.0;     // the lowest point of the shape lies on the table
  double support_noise_m = 0.003;  // scale of its Cauchy weight
  double tilt_weight = 1e-4;       // m^2/rad^2: one axis is vertical
  // Where the shape should be seen this much lower than it is, it may stand on another: ambiguous.
  double unseen_foot_m = 0.03;
  // What the viewpoint adds: planes through it that touch the visible outline touch the shape.
  int outline_rays = 96;
  double outline_weight = 1.5;      // of their mean squared distance
  double outline_noise_m = 0.0006;  // scale of their Cauchy weights where the shape extends beyond
  double outline_outside_m = 0.003;  // where it falls short
  // Outlines that may be cut off along a straight line.
  double outline_trust_m2 = 4e-7;
  double runner_up = 1.2;         // the second best start is refined if it costs less than this times the best
  double fine_tolerance = 1e-3;
  double witnesses = 400;         // independent points that the covariance counts
  double outline_clean_m2 = 1e-7; // cost of an outline below which the model explains what is seen
  bool cut_hypotheses = true;
  double nat_m2 = 6e-9;     // what a factor of e in probability weighs
  double cut_pull_m2 = 1e-7; // weight of how far it goes on
  double cut_nats = 400;     // how improbable a cut is
  double cut_beyond = 0.5; // an object goes on by this part of what is seen of it,
  double cut_sigma = 0.2;  // give or take
  int cut_iterations = 8;
  double pixel_rad = 1.0 / 525;     // the outline runs half a pixel outside the outermost points
  double table_margin_m = 0.015;    // outline this near the table is the table's doing
};

/// Fits a superquadric to at least 20 points that are not coplanar. The start is the best of
/// upright and lying boxes, cylinders and an ellipsoid; the cost is
///   mean of Cauchy(distance of a point to the surface) + prior on the volume
///   + table: Cauchy(height of the lowest point) + tilt^2
///   + outline: mean of Cauchy(distance of a tangent plane).
/// Without a table the starts stand along the principal axes and the table's terms are left out.
MethodOutcome FitAdaptive(const PointList& points_F, const std::optional<Plane>& table_F,
                          const Eigen::Vector3d& viewpoint_F, std::span<const RimPoint> rim_F,
                          const AdaptiveConfig& config);

}  // namespace beckon::pose
