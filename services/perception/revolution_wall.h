// The upright round wall of a vessel or a bottle.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "services/perception/object_grouping.h"
#include "services/perception/table_outline.h"

namespace beckon::perception {

/// The wall of a body of revolution with a vertical axis, in the table's PlaneAxes: at height h
/// above the table its radius is r0 + r1 h + r2 h^2, from where it was seen lowest up to the rim.
struct Wall {
  Eigen::Vector2d centre{0, 0};
  Eigen::Vector3d profile{0, 0, 0};  // r0, r1, r2
  double foot_height_m = 0, rim_height_m = 0;
  bool is_inside = false;  // seen from the axis

  /// As at the foot or the rim beyond them: the profile is known no further.
  double Radius(double height_m) const {
    const double h = std::clamp(height_m, foot_height_m, rim_height_m);
    return profile.dot(Eigen::Vector3d(1, h, h * h));
  }
};

/// Fits an upright body of revolution to patches: p = c + (r0 + r1 h + r2 h^2) n, with p and n the
/// patch's centre and normal seen from above and h its height, by linear least squares, then the
/// distances |p - c| = r(h) by Gauss-Newton. Nothing where the patches do not fit within the noise,
/// or too little of the circle is seen to be sure.
std::optional<Wall> FitWall(const PatchScene& scene, const PlaneAxes& axes,
                            const std::vector<int>& members);

/// Whether most of the steep patches of a group lie on a wall and face the way it does.
bool LiesOn(const PatchScene& scene, const PlaneAxes& axes, const Wall& wall,
            const std::vector<int>& members);

}  // namespace beckon::perception
