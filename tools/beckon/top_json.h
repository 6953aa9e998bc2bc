// `beckon top --json`: the table for programs.
#pragma once

#include <string>
#include <vector>

#include "tools/beckon/top_conversations.h"
#include "tools/beckon/top_model.h"

namespace beckon::tool {

/// One object, `processes`, `talks`, `last_task`, `stopped`; docs/operating.md says what is in it.
std::string TopJson(const std::vector<TopRow>& rows, const TopTalks& talks);

}  // namespace beckon::tool
