// A part of a log, as a log.
#pragma once

#include <string>

#include "services/base/result.h"
#include "tools/beckon/log_index.h"

namespace beckon::tool {

/// From `begin` to before `end`, by the logger's time and by place in the log.
struct LogRange {
  Utime begin = INT64_MIN;
  Utime end = INT64_MAX;
  int64_t offset = 0;
  int64_t end_offset = INT64_MAX;
};

/// A log of the messages in `range`, in a file without a name, which is gone when this process and
/// what it has become are. Its path; refuses a range without messages.
Result<std::string> SliceLog(const std::string& log, const LogRange& range);

}  // namespace beckon::tool
