// Where a fit may start: boxes, cylinders and an ellipsoid that fill the points' box.
#pragma once

#include <optional>
#include <vector>

#include "services/pose/fit_stage.h"

namespace beckon::pose {

/// Six starts: a box, the same turned by 45 degrees, an upright cylinder, cylinders lying along
/// either horizontal axis, an ellipsoid. With a table the box is the smallest upright one that
/// holds the points and stands on the table; without, it lies along the principal axes.
std::vector<Superquadric> Starts(const PointList& points_F, const std::optional<Plane>& table_F);

}  // namespace beckon::pose
