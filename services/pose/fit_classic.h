// The classic superquadric fit of Solina & Bajcsy, "Recovery of parametric models from range
// images: the case for superquadrics with global deformations" (IEEE PAMI 12(2), 1990).
#pragma once

#include "services/pose/fit_stage.h"

namespace beckon::pose {

struct ClassicConfig {
  int points = 500;         // at most about so many are fitted
  int max_iterations = 30;  // of Levenberg-Marquardt
  double tolerance = 1e-4;  // stop where a step lowers the error by less than this part of it
  double min_semi_axis_m = 0.005;
  double axis_margin_m = 0.005;  // a semi-axis is at most the points' half extent + this
  double min_epsilon = 0.1;
  double max_epsilon = 1.0;
  double max_taper = 0;  // +-; 0 = eleven parameters, else tapering (their eq. 19) is fitted too
};

/// Fits a superquadric to at least 20 points that are not coplanar. The start is an ellipsoid (e1 =
/// e2 = 1) in the centroid along the principal axes, its size the distances between the outermost
/// points, its z axis SymmetryAxis. From there Levenberg-Marquardt minimises SolinaProblem (their
/// eq. 17) over eleven parameters, exponents within [0.1, 1]. Neither table nor viewpoint are used.
///
/// Not theirs: sizes have an upper limit (BoundsByExtent), without which a single view's fit runs
/// off. Left out: the noise by which they accept a worse step now and then, to leave local minima.
/// Seeded restarts from perturbed results, which do the same, were measured with looser limits of
/// size: they find lower errors and worse shapes (positions at the 95th percentile 1.2 to 2.6 times
/// as far off), as the lowest errors are those of objects far too deep. Bending is left out,
/// too: no other part of the program knows it.
MethodOutcome FitClassic(const PointList& points_F, const ClassicConfig& config);

}  // namespace beckon::pose
