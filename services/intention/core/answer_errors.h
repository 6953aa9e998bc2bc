// What confirmed sessions say about how often a user's answers on a device are wrong.
#pragma once

#include <string>

#include "services/intention/core/policy.h"

namespace beckon::intention {

/// Counts an answer, given by its index among a question's `answers`, under what it meant for the
/// pair that was accepted in the end.
void Count(AnswerCounts& counts, int answers, int meant, int said);

/// Of a device, over a user's past; a session back weighs 0.98 times as much.
AnswerCounts PastAnswers(const UserHistory& history, const std::string& device);

}  // namespace beckon::intention
