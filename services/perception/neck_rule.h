// Joins the neck of a bottle, or what else tapers on top of a round body, to the body.
#pragma once

#include "services/perception/object_grouping.h"

namespace beckon::perception {

/// Joins a group that stands on a body of revolution (see FitWall), is much slimmer than it, and
/// has the same axis: things that people put on top of others hardly ever stand in the middle to
/// the millimetre, necks, caps and spray heads do.
void JoinNecks(const PatchScene& scene, PatchGroups& groups);

}  // namespace beckon::perception
