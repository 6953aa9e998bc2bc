// Joins the parts of one surface that something in front cuts apart.
#pragma once

#include "services/perception/object_grouping.h"

namespace beckon::perception {

/// Joins two groups where
/// - both show a part of one surface: a plane, or a cylinder, that fits both within the noise;
/// - the parts lie side by side as seen along that surface, across the gap between them;
/// - something nearer than the surface fills the gap in the image: had either part ended before
///   the occluder, its end would be seen;
/// - together they are no larger than an object.
void JoinAcrossOccluders(const PatchScene& scene, PatchGroups& groups);

}  // namespace beckon::perception
