// The default fit: several starts, a robust distance to the surface, and what a table-top scene
// knows.
#pragma once

#include <optional>

#include "services/base/geometry.h"
#include "services/pose/fit_stage.h"

namespace beckon::pose {

struct AdaptiveConfig {
  int coarse_points = 60;  // about as many for the starts,
  int fine_points = 300;   // and for the best two of them
  int coarse_iterations = 6;
  int fine_iterations = 50;
  double noise_m = 0.003;  // scale of the Cauchy weights of points
  double min_semi_axis_m = 0.005;
  double axis_margin =
      1.0;  // a semi-axis is at most the points' largest half extent times 1 + this
  double min_epsilon = 0.1;
  double max_epsilon = 1.0;
  double volume_prior_m2 =
      1e-6;  // cost of log volume: of two shapes that explain the points, the smaller
  // What the table adds.
  double support_weight = 1.0;     // the lowest point of the shape lies on the table
  double support_noise_m = 0.003;  // scale of its Cauchy weight
  double tilt_weight = 5e-4;       // m^2/rad^2: one axis is vertical
  double unseen_foot_m =
      0.03;  // an object whose points all lie higher may stand on another: ambiguous
  // What the viewpoint adds: planes through it that touch the visible outline touch the shape.
  int outline_planes = 24;
  double outline_weight = 1.0;      // of their mean squared distance
  double outline_noise_m = 0.0006;  // scale of their Cauchy weights
  double pixel_rad = 1.0 / 525;     // the outline runs half a pixel outside the outermost points
  double table_margin_m = 0.015;    // outline this near the table is the table's doing
};

/// Fits a superquadric to at least 20 points that are not coplanar. The start is the best of
/// upright and lying boxes, cylinders and an ellipsoid; the cost is the mean of
///   Cauchy(distance to the surface) + prior on the volume
///   + table: Cauchy(height of the lowest point) + tilt^2 + outline: Cauchy(distance of its tangent
///   planes).
/// Without a table the starts stand along the principal axes and the table's terms are left out.
MethodOutcome FitAdaptive(const PointList& points_F, const std::optional<Plane>& table_F,
                          const Eigen::Vector3d& viewpoint_F, const AdaptiveConfig& config);

}  // namespace beckon::pose
