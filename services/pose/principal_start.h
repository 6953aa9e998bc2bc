// The ellipsoid along a cloud's principal axes, from which the methods from the literature start.
#pragma once

#include "services/pose/fit_stage.h"
#include "services/pose/levenberg_marquardt.h"

namespace beckon::pose {

/// The ellipsoid with its centre in the points' centroid and the half extents of their box as
/// semi-axes. Principal axis `z_axis` (0 = of the largest spread) is z, the next two in turn are x
/// and y.
Superquadric PrincipalEllipsoid(const PrincipalBox& box, int z_axis);

/// The principal axis that Solina & Bajcsy (1990) take for z: for elongated objects the longest,
/// for flat ones the shortest. That is the one whose eigenvalue lies apart from the other two, so
/// that a thing that looks round about an axis has it as z: only about z can a superquadric be
/// round and have sharp ends.
int SymmetryAxis(const PrincipalBox& box);

/// Limits for a fit that starts from `start`: a semi-axis is at least `min_semi_axis_m` and at most
/// the half extent of the points along it + `margin_m`. What one camera sees does not say how deep
/// an object is; without the upper limit the least error is often an object far too deep.
FitBounds BoundsByExtent(const PointList& points_F, const Superquadric& start,
                         double min_semi_axis_m, double margin_m);

}  // namespace beckon::pose
