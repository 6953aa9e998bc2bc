// Points of a superquadric's surface.
#pragma once

#include <vector>

#include "services/pose/superquadric.h"

namespace beckon::pose {

/// The point of the surface in F at latitude (-pi/2 .. pi/2) and longitude, rad: Barr's spherical
/// product of two superellipses (Barr 1981), each cut by the ray of that angle. Circles of latitude
/// are level, the edges of boxes and cylinders are at 45 degrees, and unlike with Barr's own angles
/// points do not crowd there.
Eigen::Vector3d SurfacePoint(const Superquadric& shape, double latitude, double longitude);

/// `count` points of the surface in F, evenly spread by area (to about a percent) and apart from
/// each other, for all exponents, elongations and tapers; for a sphere the Fibonacci lattice. The
/// same points every time.
std::vector<Eigen::Vector3d> SampleSurface(const Superquadric& shape, int count);

/// Mean radial distance of b's surface from a's, both ways, m: how different two shapes are
/// whatever their parameters (a box has many).
double ShapeDifference(const Superquadric& a, const Superquadric& b);

}  // namespace beckon::pose
