// A session of a scenario file from its JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "services/intention/core/evaluation.h"

namespace beckon::intention {

/// {"user", "scene": [{"category", "distance_m", "lateral_m"?}, ..], "want": {"category",
/// "instance", "action"}, "utime"?}. Fails with the key, what was expected and what was found.
Result<ScenarioSession> ParseScenarioSession(const nlohmann::json& line,
                                             const Affordances& affordances);

}  // namespace beckon::intention
