// Tasks in a few words, as lists show them.
#pragma once

#include <string>

#include "lcmtypes/messages.h"

namespace beckon::tool {

/// "Open Carton 1".
std::string TaskWords(const msg::Task& task);

}  // namespace beckon::tool
