// The visible outline of a cloud as planes through the viewpoint.
#pragma once

#include <optional>
#include <vector>

#include "services/pose/fit_stage.h"

namespace beckon::pose {

/// A plane through the viewpoint that touches what is seen from one side: all points have n·(p - v)
/// <= 0.
struct TangentPlane {
  Eigen::Vector3d normal_F;  // unit, outward
};

/// `count` planes evenly turned around the line of sight to the points, each moved outward by half
/// a pixel. Left out are those that touch the outline within `table_margin_m` of the table, where
/// an object and its table cannot be told apart.
std::vector<TangentPlane> OutlinePlanes(const PointList& points_F,
                                        const Eigen::Vector3d& viewpoint_F,
                                        const std::optional<Plane>& table_F, int count,
                                        double pixel_rad, double table_margin_m);

}  // namespace beckon::pose
