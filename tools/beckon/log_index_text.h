// A log's index for people and for programs.
#pragma once

#include <string>

#include "tools/beckon/log_index.h"

namespace beckon::tool {

/// The tables of `beckon replay LOG --list`: conversations, processes, channels.
std::string RenderIndex(const LogIndex& index);

/// LOG.index.json; docs/formats.md says what is in it.
std::string IndexJson(const LogIndex& index, const std::string& log);

}  // namespace beckon::tool
