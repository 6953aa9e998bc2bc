// Joins what is too small to be an object on its own to what it is a part of.
#pragma once

#include "services/perception/object_grouping.h"

namespace beckon::perception {

/// Joins groups of less than 30 cm2 to the one they share the longest border with. Those of less
/// than 20 cm2 that touch nothing, and are not on the table, are handles, caps and the like seen
/// across a gap of depth: nothing floats, so they join what is nearest.
void JoinFragments(const PatchScene& scene, PatchGroups& groups);

}  // namespace beckon::perception
