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
  // The starts are fitted to about coarse_points and a third of the rays, the best of them to
  // fine_points and all rays.
  int coarse_points = 60;
  int fine_points = 300;
  int coarse_iterations = 6;
  int fine_iterations = 50;
  double fine_tolerance = 1e-3;  // stop where a step lowers the cost by less than this part of it
  // A start of another shape is refined too where it costs less than this times the best.
  double runner_up = 1.2;
  double noise_m = 0.002;  // scale of the Cauchy weights of points
  double min_semi_axis_m = 0.005;
  // A semi-axis is at most 1 + this times the points' largest half extent.
  double axis_margin = 1.0;
  double min_epsilon = 0.1;
  double max_epsilon = 1.0;
  // Times log volume: of two shapes that fit as well, the smaller. Not where a side is cut off.
  double volume_prior_m2 = 5e-7;
  // Times the squared deviations of the log semi-axes from their mean: of two shapes that fit as
  // well, the one of more even proportions. Few objects are like a sheet.
  double proportion_prior_m2 = 1.2e-7;
  // What the table adds.
  double support_weight = 1.0;     // the lowest point of the shape lies on the table
  double support_noise_m = 0.003;  // scale of its Cauchy weight
  double tilt_weight = 5e-5;       // m^2/rad^2: one axis is vertical
  // Of the squared height by which the shape rises more than top_slack_m above what is seen: who
  // looks down on a thing sees its top, unless that is cut off.
  double top_weight = 0.002;
  double top_slack_m = 0.005;
  // Where the shape should be seen this much lower than it is, it may stand on another: ambiguous.
  double unseen_foot_m = 0.03;
  // What the viewpoint adds: rays along the visible outline graze the shape.
  int outline_rays = 96;            // most of them
  double outline_weight = 1.5;      // of their mean squared distance
  double outline_noise_m = 0.0006;  // scale of their Cauchy weights where the shape goes on beyond,
  double outline_outside_m = 0.003;  // and where it falls short of the ray
  double outline_trust_m2 = 4e-7;    // an outline that costs as much as this is worth half
  // And one that costs more than this lowers the covariance's claims.
  double outline_clean_m2 = 1e-7;
  double pixel_rad = 1.0 / 525;   // the outline runs half a pixel outside the outermost points
  double table_margin_m = 0.015;  // outline this near the table is the table's doing
  // Where nobody knows what lies beyond the outline, a straight piece of it may be where something
  // cuts the object off. It is if that lowers the cost by more than cut_charge_m2, or less the
  // worse the whole outline fits. Of several pieces the straightest is the likeliest, since the
  // edges of objects look ragged; the others are charged cut_ragged_m2 for each square pixel by
  // which their mean square deviation is larger. The object is then expected to go on by cut_beyond
  // of what is seen of it, give or take cut_sigma.
  bool cut_hypotheses = true;
  double cut_charge_m2 = 2.4e-6;
  double cut_ragged_m2 = 2e-7;
  double cut_pull_m2 = 1e-7;  // weight of that expectation
  double cut_beyond = 0.5;
  double cut_sigma = 0.2;
  int cut_iterations = 5;
  // How many points the covariance counts, as if independent, where all fits.
  double witnesses = 500;
};

/// Fits a superquadric to at least 20 points that are not coplanar. The start is the best of
/// upright and lying boxes, cylinders and an ellipsoid; the cost is
///   mean of Cauchy(distance of a point to the surface) + priors on volume and proportions
///   + table: Cauchy(height of the lowest point) + tilt^2 + (height above the seen top)^2
///   + outline: mean of Cauchy(distance of a ray to the surface).
/// A ray of the outline grazes the surface: the point of the ray where the gauge is least lies on
/// it. Where something cuts the object off, the rays there say nothing, the prior on the volume is
/// left out, and the shape is expected to go on. `rim_F` tells where that is; where it is empty, it
/// is found out (see AdaptiveConfig). Without a table the starts lie along the principal axes and
/// the table's terms are left out. Deterministic; the inner loop does not allocate.
MethodOutcome FitAdaptive(const PointList& points_F, const std::optional<Plane>& table_F,
                          const Eigen::Vector3d& viewpoint_F, std::span<const RimPoint> rim_F,
                          const AdaptiveConfig& config);

}  // namespace beckon::pose
