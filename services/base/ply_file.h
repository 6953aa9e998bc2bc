// The PLY format (Stanford) in memory.
#pragma once

#include <string_view>

#include "services/base/rgbd.h"

namespace beckon::cloud {

/// A cloud from the vertices of a PLY file. It is organised where the file says so (a `camera`
/// element's viewport or `obj_info num_cols / num_rows` that match the number of vertices) or has
/// exactly 640x480 vertices. Other elements are skipped.
Result<Cloud> ParsePly(std::string_view bytes);

}  // namespace beckon::cloud
