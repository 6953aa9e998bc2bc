// The PCD format (Point Cloud Library, versions .5 to .7) in memory.
#pragma once

#include <string>
#include <string_view>

#include "services/base/rgbd.h"

namespace beckon::cloud {

/// A cloud from the bytes of a PCD file. Its VIEWPOINT is ignored: coordinates are taken as they
/// are.
Result<Cloud> ParsePcd(std::string_view bytes);

/// The bytes of a binary PCD file.
std::string FormatPcd(const Cloud& cloud);

}  // namespace beckon::cloud
