// What the methods share: voxel grids, principal axes, distances.
#include "services/pose/fit_stage.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace beckon::pose {
namespace {

struct VoxelHash {
  size_t operator()(const std::array<int64_t, 3>& v) const {
    const auto mix = [](int64_t i, uint64_t prime) { return static_cast<uint64_t>(i) * prime; };
    return mix(v[0], 73856093) ^ mix(v[1], 19349663) ^ mix(v[2], 83492791);
  }
};

}  // namespace

PointList Thinned(const PointList& points, int count) {
  const size_t most = static_cast<size_t>(std::max(count, 1));
  const size_t step = std::max<size_t>((points.size() + most - 1) / most, 1);
  PointList thinned;
  thinned.reserve(most);
  for (size_t i = 0; i < points.size(); i += step) thinned.push_back(points[i]);
  return thinned;
}

PointList VoxelCentroids(const PointList& points, double voxel_m) {
  std::unordered_map<std::array<int64_t, 3>, size_t, VoxelHash> index;
  index.reserve(points.size());
  PointList sums;
  std::vector<int> counts;
  for (const auto& p : points) {
    const std::array<int64_t, 3> voxel{static_cast<int64_t>(std::floor(p.x() / voxel_m)),
                                       static_cast<int64_t>(std::floor(p.y() / voxel_m)),
                                       static_cast<int64_t>(std::floor(p.z() / voxel_m))};
    const auto [it, fresh] = index.try_emplace(voxel, sums.size());
    if (fresh) {
      sums.push_back(p);
      counts.push_back(1);
    } else {
      sums[it->second] += p;
      ++counts[it->second];
    }
  }
  for (size_t i = 0; i < sums.size(); ++i) sums[i] /= counts[i];
  return sums;
}

PrincipalBox ComputePrincipalBox(const PointList& points) {
  PrincipalBox box;
  box.centroid.setZero();
  for (const auto& p : points) box.centroid += p;
  box.centroid /= static_cast<double>(points.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto& p : points) covariance += (p - box.centroid) * (p - box.centroid).transpose();
  covariance /= static_cast<double>(points.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  box.axes.col(0) = eigen.eigenvectors().col(2);
  box.axes.col(1) = eigen.eigenvectors().col(1);
  box.axes.col(2) = box.axes.col(0).cross(box.axes.col(1));
  box.spread = eigen.eigenvalues().reverse().cwiseMax(0).cwiseSqrt();
  Eigen::Vector3d lo = Eigen::Vector3d::Constant(1e300), hi = -lo;
  for (const auto& p : points) {
    const Eigen::Vector3d q = box.axes.transpose() * (p - box.centroid);
    lo = lo.cwiseMin(q);
    hi = hi.cwiseMax(q);
  }
  box.half_extents = 0.5 * (hi - lo);
  box.middle = box.centroid + box.axes * (0.5 * (hi + lo));
  return box;
}

SurfaceDistance DistanceToSurface(const Superquadric& shape, const Eigen::Vector3d& p_F) {
  constexpr double kMaxShrink = 4;  // keeps the Jacobian bounded near the centre
  const Eigen::Vector3d arm_F = p_F - shape.X_FO.translation();
  const GaugeDerivatives d = DifferentiateGauge(shape, shape.X_FO.linear().transpose() * arm_F);
  // grad g = g grad log g, so (g - 1) / |grad g| = (1 - 1/g) / |grad log g|.
  const double by_slope = 1 / std::max(d.point.norm(), 1e-9);
  const double by_g = std::exp(-d.log_g);
  SurfaceDistance result;
  result.distance_m = (1 - by_g) * by_slope;
  // Taken at the point of the surface on the same ray, p/g, where the slope is g times as large:
  // log g changes by the same amount there, but for a translation, which moves it by g times as
  // much.
  FillJacobian(shape, arm_F, d, std::min(by_g, kMaxShrink) * by_slope, by_slope, result.jacobian);
  return result;
}

}  // namespace beckon::pose
