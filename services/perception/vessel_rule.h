// Joins the inside of an upright round vessel to its outer wall.
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

/// A vessel whose inside is seen.
struct Vessel {
  int patch = 0;  // one of its own
  Wall wall;
};

/// Fits an upright body of revolution to patches: p = c + (r0 + r1 h + r2 h^2) n, with p and n the
/// patch's centre and normal seen from above and h its height; linear least squares. Nothing where
/// the patches do not fit within the noise, or too little of the circle is seen to be sure.
std::optional<Wall> FitWall(const PatchScene& scene, const PlaneAxes& axes,
                            const std::vector<int>& members);

/// Whether a patch lies below the rim and within it: on the wall's inside, or on the bottom.
bool IsWithin(const PatchScene& scene, const PlaneAxes& axes, const Wall& wall, const Patch& patch);

/// What lies below the rim of a round vessel and within it belongs to the vessel: cups, bowls,
/// mugs, pots. So does what they hold, unless it sticks out. A wall is a group, or two that touch
/// and are the inside of one: noise tears wide bowls, which bend little from patch to patch.
std::vector<Vessel> JoinInsides(const PatchScene& scene, PatchGroups& groups);

/// Whether a place near the table's height is on the bottom of a vessel.
bool IsBottom(const PatchScene& scene, const PlaneAxes& axes, const Vessel& vessel,
              const Eigen::Vector3d& p);

}  // namespace beckon::perception
