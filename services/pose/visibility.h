// What a camera above a table sees of an object's top and foot.
#pragma once

#include "services/base/geometry.h"
#include "services/pose/even_spread.h"
#include "services/pose/superquadric.h"

namespace beckon::pose {

/// The height above the table of the highest point, m, but for a few that fly; infinite where all
/// of them may.
double SeenTop(const SpreadPoints& spread_F, const Plane& table_F);

/// Whether the side of the shape that faces the camera reaches `gap_m` lower than the points do:
/// its foot is hidden behind another object, or it stands on one, and how far down it goes is not
/// known.
bool FootIsUnseen(const Superquadric& shape, const PointList& points_F, const Plane& table_F,
                  const Eigen::Vector3d& viewpoint_F, double gap_m);

}  // namespace beckon::pose
