// The multi-scale superquadric fit of Duncan, Sarkar, Alqasemi & Dubey, "Multi-scale superquadric
// fitting for efficient shape and pose recovery of unknown objects" (ICRA 2013).
#pragma once

#include <vector>

#include "services/pose/fit_stage.h"

namespace beckon::pose {

struct MultiscaleConfig {
  std::vector<double> voxels_m{0.030, 0.02325, 0.0165};  // coarse to fine; all points follow
  int max_iterations = 20;                               // of Levenberg-Marquardt, a level
  double stop_change = 0.02;  // stop where a level changes the mean error by less than this part
  double min_semi_axis_m = 0.020;
  double axis_margin_m = 0.015;  // a semi-axis is at most the box's half extent + this
  double min_epsilon = 0.1;
  double max_epsilon = 1.0;
  double max_taper = 0;  // +-; the paper's program has 0.25, switched off
};

/// Fits a superquadric to at least 20 points that are not coplanar. From the centroid and the
/// principal axes, each of which is tried as z on the coarsest grid; every level starts from the
/// one before. Each level minimises Solina & Bajcsy's (1990, eq. 17) sum of [sqrt(a1 a2 a3) (F^e1 -
/// 1)]^2. Neither table nor viewpoint are used.
MethodOutcome FitMultiscale(const PointList& points_F, const MultiscaleConfig& config);

}  // namespace beckon::pose
