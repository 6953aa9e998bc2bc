// The history as people read it.
#pragma once

#include <string>
#include <vector>

#include "services/intention/core/memory.h"
#include "services/intention/store.h"

namespace beckon::intention {

/// A line a session (time, user, task, questions, device), then a line a user: how many questions
/// the first ten sessions took, how many the last ten, and a small plot.
std::string HistoryText(const std::vector<SessionRecord>& sessions);

/// A line an origin: how many rows came from there, how many of them count as sessions, how many
/// are forgotten, when it last wrote. Empty where there are no rows.
std::string OriginsText(const std::vector<OriginSummary>& origins);

/// "2026-11-22 23:10:05", in the machine's time zone.
std::string LocalTime(Utime utime);

}  // namespace beckon::intention
