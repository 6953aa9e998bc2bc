// Ground truth as JSON: what capture writes beside its renderings, and what `--truth` prints.
#pragma once

#include <string>

#include "services/base/result.h"
#include "services/capture/scene_description.h"

namespace beckon::capture {

/// {"table": {"normal", "offset_m"} | null, "intrinsics": {"fx", ..}, "objects": [{"label",
/// "category", "centroid_C", "box_C": {"min", "max"}, "visible_points", "X_CO": {"position",
/// "rotation_wxyz"} | null, "X_WO": .. | null}] | null}. Metres, frame C.
std::string ToJson(const SceneDescription& description);

/// The reverse, of files written so; fails on anything else.
Result<SceneDescription> ReadDescription(const std::string& path);

/// Category of each object of each image: {"stem": {"2": "Box", ..}, ..}; the entry of `stem`,
/// empty where it has none.
Result<std::map<int, std::string>> ReadCategories(const std::string& path, const std::string& stem);

}  // namespace beckon::capture
