// The bodies of history rows: JSON, from and to the records of core/memory.h.
#pragma once

#include <string>

#include "services/intention/core/memory.h"

namespace beckon::intention {

std::string ToBody(const SessionRecord& session);
std::string ToBody(const LabelRecord& label);

/// Fail with what is missing or wrong.
Result<SessionRecord> SessionFromBody(const std::string& body);
Result<LabelRecord> LabelFromBody(const std::string& body);

/// What the table keeps beside a body.
struct RowHead {
  std::string uid;
  std::string user;
  Utime utime = 0;
};

/// Checks a body of any kind; kinds that this program does not know only need to be a JSON object.
Result<RowHead> HeadOf(const std::string& origin, int64_t seq, const std::string& kind,
                       const std::string& body);

}  // namespace beckon::intention
