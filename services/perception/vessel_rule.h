// Joins the inside of an upright round vessel to its outer wall.
#pragma once

#include <vector>

#include "services/perception/revolution_wall.h"

namespace beckon::perception {

/// A vessel whose inside is seen.
struct Vessel {
  int patch = 0;  // one of its own
  Wall wall;
};

/// What lies below the rim of a round vessel and within it belongs to the vessel: cups, bowls,
/// mugs, pots. So does what they hold, unless it sticks out. A wall is a group, or two that touch
/// and are the inside of one: noise tears wide bowls, which bend little from patch to patch.
std::vector<Vessel> JoinInsides(const PatchScene& scene, PatchGroups& groups);

/// Whether a place near the table's height is on the bottom of a vessel.
bool IsBottom(const PatchScene& scene, const PlaneAxes& axes, const Vessel& vessel,
              const Eigen::Vector3d& p);

}  // namespace beckon::perception
