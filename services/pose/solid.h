// A superquadric as a solid of uniform density: volume, centroid, second moments, inertia.
#pragma once

#include "services/pose/superquadric.h"

namespace beckon::pose {

/// Volume, m^3: 2 a1 a2 a3 e1 e2 B(e1/2 + 1, e1) B(e2/2, e2/2) (Jaklic, Leonardis & Solina 2000,
/// section 2.4), tapering included.
double Volume(const Superquadric& shape);

/// The moments of a solid up to the second.
struct SolidMoments {
  double volume_m3 = 0;
  Eigen::Vector3d centroid_F;    // m; tapering moves it along the shape's z away from the centre
  Eigen::Matrix3d covariance_F;  // m^2, mean of (p - centroid)(p - centroid)^T over the solid
};
SolidMoments ComputeSolidMoments(const Superquadric& shape);

/// Inertia tensor about the centroid, kg m^2, in the axes of F: mass (tr(S) 1 - S), S being the
/// covariance.
Eigen::Matrix3d Inertia(const SolidMoments& solid, double mass_kg);

}  // namespace beckon::pose
