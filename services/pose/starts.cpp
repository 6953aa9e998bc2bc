// Where a fit may start: boxes, cylinders and an ellipsoid that fill the points' box.
#include "services/pose/starts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace beckon::pose {
namespace {

constexpr double kSharp = 0.3, kRound = 1.0;

// A box: axes are columns, the third is up.
struct Box {
  Eigen::Matrix3d axes;
  Eigen::Vector3d middle;
  Eigen::Vector3d half;
};

Box BoxAlong(const PointList& points, const Eigen::Matrix3d& axes) {
  Eigen::Vector3d lo = Eigen::Vector3d::Constant(1e300), hi = -lo;
  for (const auto& p : points) {
    const Eigen::Vector3d q = axes.transpose() * p;
    lo = lo.cwiseMin(q);
    hi = hi.cwiseMax(q);
  }
  return {axes, axes * (0.5 * (lo + hi)), 0.5 * (hi - lo)};
}

Eigen::Matrix3d Turned(const Eigen::Matrix3d& axes, double angle) {
  return axes * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

// The upright box of the smallest footprint, found to 3 degrees, its foot on the table.
Box StandingBox(const PointList& points, const Plane& table) {
  constexpr int kTurns = 30;
  Eigen::Matrix3d axes;
  axes.col(2) = table.normal;
  axes.col(0) = table.normal.unitOrthogonal();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  Box best;
  double smallest = 1e300;
  for (int k = 0; k < kTurns; ++k) {
    const Box box = BoxAlong(points, Turned(axes, 0.5 * std::numbers::pi * k / kTurns));
    const double footprint = box.half.x() * box.half.y();
    if (footprint < smallest) {
      smallest = footprint;
      best = box;
    }
  }
  const double top = std::max(table.Distance(best.middle) + best.half.z(), 0.002);
  best.middle += table.normal * (0.5 * top - table.Distance(best.middle));
  best.half.z() = 0.5 * top;
  return best;
}

// The shape that fills `box` with box axis `z_axis` as z.
Superquadric Fill(const Box& box, int z_axis, double e1, double e2) {
  Superquadric shape;
  for (int i = 0; i < 3; ++i) {
    const int from = (z_axis + 1 + i) % 3;
    shape.X_FO.linear().col(i) = box.axes.col(from);
    shape.semi_axes[i] = std::max(box.half[from], 0.001);
  }
  shape.X_FO.translation() = box.middle;
  shape.epsilon = {e1, e2};
  return shape;
}

Superquadric Cylinder(const Box& box, int z_axis) {
  Superquadric shape = Fill(box, z_axis, kSharp, kRound);
  // The visible part of a round thing is narrower along the line of sight than it is.
  shape.semi_axes.head<2>().setConstant(shape.semi_axes.head<2>().maxCoeff());
  return shape;
}

}  // namespace

std::vector<Superquadric> Starts(const PointList& points_F, const std::optional<Plane>& table_F) {
  const Box box = table_F ? StandingBox(points_F, *table_F)
                          : BoxAlong(points_F, ComputePrincipalBox(points_F).axes);
  Box diagonal = BoxAlong(points_F, Turned(box.axes, std::numbers::pi / 4));
  diagonal.middle = box.middle;
  diagonal.half.z() = box.half.z();
  diagonal.half.head<2>() /= std::numbers::sqrt2;
  return {Fill(box, 2, kSharp, kSharp),
          Fill(diagonal, 2, kSharp, kSharp),
          Cylinder(box, 2),
          Cylinder(box, 0),
          Cylinder(box, 1),
          Fill(box, 2, kRound, kRound)};
}

}  // namespace beckon::pose
