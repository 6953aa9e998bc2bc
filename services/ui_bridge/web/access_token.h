// What others than this machine have to show before the page's server listens to them.
#pragma once

#include <string>

#include "services/base/result.h"

namespace beckon::ui_bridge::web {

/// 128 bits of the system's randomness as 32 hexadecimal digits. Kept in `path`, for its owner's
/// eyes alone, so that pages find their way back after a restart; a file that others may read, or
/// that holds no token, is replaced.
Result<std::string> LoadOrMakeToken(const std::string& path);

}  // namespace beckon::ui_bridge::web
