// Joins the parts of one surface that something in front cuts apart.
#pragma once

#include "services/perception/object_grouping.h"

namespace beckon::perception {

/// Joins two groups where both show parts of one surface (a plane or a cylinder, within the noise)
/// and everything between them in the image is nearer than that surface.
void JoinAcrossOccluders(const PatchScene& scene, PatchGroups& groups);

}  // namespace beckon::perception
