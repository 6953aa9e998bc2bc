// Smoothing a cloud by moving least squares.
#include "services/pose/smoothing.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

namespace beckon::pose {
namespace {

constexpr size_t kFewestNeighbours = 6;  // coefficients of a quadratic patch

using Cell = std::array<int64_t, 3>;

Cell CellOf(const Eigen::Vector3d& p, double size_m) {
  return {static_cast<int64_t>(std::floor(p.x() / size_m)),
          static_cast<int64_t>(std::floor(p.y() / size_m)),
          static_cast<int64_t>(std::floor(p.z() / size_m))};
}

// The point of the weighted quadratic patch through `neighbours` over or under `p`.
Eigen::Vector3d OnPatch(const Eigen::Vector3d& p, const PointList& neighbours, double radius_m) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& q : neighbours) middle += q;
  middle /= static_cast<double>(neighbours.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto& q : neighbours) covariance += (q - middle) * (q - middle).transpose();
  const Eigen::Matrix3d axes =  // the normal first
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors();

  Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> b = Eigen::Matrix<double, 6, 1>::Zero();
  const double by_radius = 1 / radius_m;
  for (const auto& q : neighbours) {
    const Eigen::Vector3d arm = axes.transpose() * (q - p) * by_radius;
    const double u = arm.y(), v = arm.z();
    const double weight = std::exp(-arm.squaredNorm());
    Eigen::Matrix<double, 6, 1> terms;
    terms << 1, u, v, u * u, u * v, v * v;
    A += weight * terms * terms.transpose();
    b += weight * arm.x() * terms;
  }
  A.diagonal().array() += 1e-9;
  const double height = A.ldlt().solve(b)[0] * radius_m;
  // A patch does not move a point farther than its neighbours lie.
  return std::abs(height) <= radius_m ? Eigen::Vector3d(p + height * axes.col(0)) : p;
}

}  // namespace

PointList SmoothedByMovingLeastSquares(const PointList& points, double radius_m) {
  std::map<Cell, PointList> cells;
  for (const auto& p : points) cells[CellOf(p, radius_m)].push_back(p);
  PointList smoothed, neighbours;
  smoothed.reserve(points.size());
  for (const auto& p : points) {
    const Cell cell = CellOf(p, radius_m);
    neighbours.clear();
    for (int k = 0; k < 27; ++k) {
      const auto found =
          cells.find({cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k / 9 - 1});
      if (found == cells.end()) continue;
      for (const auto& q : found->second) {
        if ((q - p).squaredNorm() <= radius_m * radius_m) neighbours.push_back(q);
      }
    }
    smoothed.push_back(neighbours.size() < kFewestNeighbours ? p
                                                             : OnPatch(p, neighbours, radius_m));
  }
  return smoothed;
}

}  // namespace beckon::pose
