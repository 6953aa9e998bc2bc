// The ellipsoid along a cloud's principal axes, from which the methods from the literature start.
#include "services/pose/principal_start.h"

namespace beckon::pose {

Superquadric PrincipalEllipsoid(const PrincipalBox& box, int z_axis) {
  Superquadric start;
  for (int i = 0; i < 3; ++i) {
    const int from = (z_axis + 1 + i) % 3;
    start.X_FO.linear().col(i) = box.axes.col(from);
    start.semi_axes[i] = box.half_extents[from];
  }
  start.X_FO.translation() = box.centroid;
  return start;
}

int SymmetryAxis(const PrincipalBox& box) {
  const Eigen::Vector3d eigenvalues = box.spread.array().square();
  return eigenvalues[0] - eigenvalues[1] >= eigenvalues[1] - eigenvalues[2] ? 0 : 2;
}

FitBounds BoundsByExtent(const PointList& points_F, const Superquadric& start,
                         double min_semi_axis_m, double margin_m) {
  Eigen::Vector3d lo = Eigen::Vector3d::Constant(1e300), hi = -lo;
  for (const auto& p : points_F) {
    const Eigen::Vector3d q = start.X_FO.linear().transpose() * p;
    lo = lo.cwiseMin(q);
    hi = hi.cwiseMax(q);
  }
  FitBounds bounds;
  bounds.min_axes.setConstant(min_semi_axis_m);
  bounds.max_axes = (0.5 * (hi - lo).array() + margin_m).max(min_semi_axis_m);
  return bounds;
}

}  // namespace beckon::pose
