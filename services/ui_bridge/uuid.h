// Names that nobody else chooses.
#pragma once

#include <string>

namespace beckon::ui_bridge {

/// A random UUID (RFC 4122, version 4) from the system's entropy.
std::string NewUuid();

}  // namespace beckon::ui_bridge
