// Volume and points of a superquadric's surface.
#pragma once

#include <vector>

#include "services/pose/superquadric.h"

namespace beckon::pose {

/// Volume, m^3: 2 a1 a2 a3 e1 e2 B(e1/2 + 1, e1) B(e2/2, e2/2) (Jaklic, Leonardis & Solina 2000,
/// eq. 2.60), times the mean of the taper's cross-section.
double Volume(const Superquadric& shape);

/// About `count` points of the surface in F, about evenly spread: the rays of a Fibonacci sphere,
/// stretched by the semi-axes, cut with the surface. Deterministic.
std::vector<Eigen::Vector3d> SampleSurface(const Superquadric& shape, int count);

/// The point of the surface in F at latitude (-pi/2 .. pi/2) and longitude of the sphere that the
/// semi-axes stretch, for drawing. Unlike the usual parametrisation (Barr 1981) it does not crowd a
/// box's edges.
Eigen::Vector3d SurfacePoint(const Superquadric& shape, double latitude, double longitude);

/// Mean distance of b's surface from a's, both ways, m: how different two shapes are whatever their
/// parameters (a box has many).
double ShapeDifference(const Superquadric& a, const Superquadric& b);

}  // namespace beckon::pose
