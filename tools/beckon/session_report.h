// A session as a line of JSON, and whether its task was what the user wanted.
#pragma once

#include <string>

#include "services/base/scene_truth.h"
#include "tools/beckon/catalogue.h"
#include "tools/beckon/session_observer.h"

namespace beckon::tool {

/// Action and category are as wanted and, where the truth is known, the object is the nearest of
/// its category that really stands there.
bool IsCorrect(const SessionRecord& record, const Want& want, const SceneTruth& truth);

/// One line, without the newline. `want` may be null (a person's session): "correct" is null then.
std::string ReportLine(const SessionRecord& record, const Want* want, const SceneTruth& truth);

/// Why a session is not correct, for people.
std::string Complaint(const SessionRecord& record, const Want& want);

}  // namespace beckon::tool
