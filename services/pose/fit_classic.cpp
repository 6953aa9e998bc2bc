// The classic superquadric fit of Solina & Bajcsy (1990).
#include "services/pose/fit_classic.h"

#include "services/pose/principal_start.h"
#include "services/pose/solina_problem.h"

namespace beckon::pose {

MethodOutcome FitClassic(const PointList& points_F, const ClassicConfig& config) {
  const PointList points = Thinned(points_F, config.points);
  const PrincipalBox box = ComputePrincipalBox(points);
  const Superquadric start = PrincipalEllipsoid(box, SymmetryAxis(box));
  FitBounds bounds = BoundsByExtent(points, start, config.min_semi_axis_m, config.axis_margin_m);
  bounds.min_epsilon = config.min_epsilon;
  bounds.max_epsilon = config.max_epsilon;
  bounds.max_taper = config.max_taper;
  LmOptions options;
  options.max_iterations = config.max_iterations;
  options.relative_tolerance = config.tolerance;
  const LmResult fit = Minimise(SolinaProblem(points), start, bounds, options);
  return {fit.shape, fit.converged, false, {fit.iterations}};
}

}  // namespace beckon::pose
