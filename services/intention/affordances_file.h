// Reads affordances.toml.
#pragma once

#include <string>

#include "services/intention/core/affordances.h"

namespace beckon::intention {

/// [categories] Name = ["Action", ...]; [actions] Name = "words". Fails with the file's name, the
/// place and what to do.
Result<Affordances> ReadAffordances(const std::string& path);

}  // namespace beckon::intention
