// Distances of many points and rays from one superquadric, with derivatives: the inner loop of the
// adaptive fit. In single precision, eight at a time, without allocation.
#pragma once

#include <Eigen/Core>
#include <array>

#include "services/pose/superquadric.h"

namespace beckon::pose {

/// Most points that a block holds.
inline constexpr int kBlockSize = 512;

/// Points or directions, a coordinate an array. The arrays are filled up to a multiple of eight
/// with points of weight 0.
struct PointBlock {
  alignas(32) std::array<float, kBlockSize> x, y, z;  // m
  alignas(32) std::array<float, kBlockSize> weight;
  int size = 0;

  bool full() const { return size == kBlockSize; }
  /// Adds a point; the block is not full.
  void Add(const Eigen::Vector3d& p, double point_weight);
  /// Fills up with points of weight 0; before the kernels run.
  void Pad();
  Eigen::Vector3d at(int i) const {
    const size_t k = static_cast<size_t>(i);
    return {x[k], y[k], z[k]};
  }
};

/// s^2 log(1 + (r/s)^2) (Cauchy; Zhang 1997, table 1), with a scale for each side of the surface,
/// m.
struct CauchyLoss {
  double inside_m, outside_m;
};

/// Order of the parameters: log a1 a2 a3, e1 e2, rotation vector and translation in F.
inline constexpr int kKernelParameters = 11;
struct DistanceSum {
  double cost = 0;                                                      // m^2
  Eigen::Matrix<double, kKernelParameters, 1> gradient;                 // J^T W r
  Eigen::Matrix<double, kKernelParameters, kKernelParameters> hessian;  // J^T W J
};

/// Sum over the points of weight * loss(distance), the distance being the first-order one that
/// DistanceToSurface() gives. Taper is ignored.
DistanceSum SumDistances(const Superquadric& shape, const PointBlock& points_F, CauchyLoss loss);

/// Moves each of `points_F` along its ray from `viewpoint_F` in `rays_F` to where the ray is
/// deepest inside the shape, or passes it closest: the minimum of the gauge. A ray that grazes the
/// shape has a distance of 0 there, and, as the derivative along the ray vanishes, the point may be
/// held fixed when differentiating. Every of `steps` narrows the place down to 0.62 of what it was,
/// from twice the shape's reach.
void FindDeepest(const Superquadric& shape, const Eigen::Vector3d& viewpoint_F,
                 const PointBlock& rays_F, int steps, PointBlock& points_F);

/// A distance a point, aligned as the kernels store them.
struct alignas(32) BlockDistances : std::array<float, kBlockSize> {};

/// Signed first-order distances, m.
void ComputeDistances(const Superquadric& shape, const PointBlock& points_F,
                      BlockDistances& distances_m);

/// Sum over the points of weight * |p| |1 - 1/g|, the radial distance, m.
double SumRadialDistances(const Superquadric& shape, const PointBlock& points_F);

}  // namespace beckon::pose
