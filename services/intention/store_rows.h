// The bodies of history rows: JSON, from and to the records of core/memory.h.
#pragma once

#include <string>

#include "services/intention/core/history_row.h"
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
  uint64_t hash = 0;  // of the row as it was written: an erased one carries it
};

/// What remains of a row that was forgotten: that there was one, under this number.
inline constexpr char kErased[] = "erased";
inline constexpr char kForget[] = "forget";

/// Checks a row of any kind; kinds that this program does not know only need to be a JSON object.
/// Rows whose body has no id of their own are called after origin and seq, unless it has a "uid".
Result<RowHead> HeadOf(const HistoryRow& row);

/// The body with a "uid", where it has none: what a row is called by that gets another number.
std::string WithUid(const std::string& body, const std::string& uid);

/// The row with a hybrid time where it has none (older versions): the one in its body.
HistoryRow Timed(HistoryRow row, const RowHead& head);

}  // namespace beckon::intention
