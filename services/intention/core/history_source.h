// What the sharing of histories needs of the memory. The SQLite store is behind it in the service,
// a plain list in tests.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "services/base/result.h"
#include "services/intention/core/history_row.h"

namespace beckon::intention {

/// What became of rows that another machine sent.
struct TakenRows {
  int added = 0;
  std::map<std::string, int> refused;  // by reason: "body", "contradiction", ...
  int far_future = 0;                  // added, but their time moves nobody's clock
};

class HistorySource {
 public:
  virtual ~HistorySource() = default;

  /// Of every origin, the rows 1 .. seq that are there without a gap.
  virtual const std::map<std::string, HistoryHead>& Heads() = 0;
  /// The checksum over rows 1 .. seq; nothing where they are not all there. 0 of no rows.
  virtual std::optional<uint64_t> ChainAt(const std::string& origin, int64_t seq) = 0;
  /// Rows seq+1, seq+2, ... of an origin's head: as many as fit both limits, but at least one
  /// where there is one. `max_bytes` counts bodies.
  virtual Result<std::vector<HistoryRow>> RowsAfter(const std::string& origin, int64_t seq,
                                                    size_t max_rows, size_t max_bytes) = 0;
  /// Adds rows that follow their origin's head, each the one before it; what is bad is refused
  /// alone, with those that follow it in its origin. One transaction. `now`: of the clock on the
  /// wall [us].
  virtual Result<TakenRows> Take(const std::vector<HistoryRow>& rows, Utime now) = 0;

  /// The origin that this machine's next rows get.
  virtual std::string WriteOrigin() = 0;
  /// From now on writes under a new origin: somebody else writes under this one.
  virtual Status LeaveOrigin(const std::string& reason, Utime now) = 0;
  /// Two histories of `origin` differ from `seq` on, and this one yields: what it has from there
  /// on is written again under this machine's own origin, with the same ids, and makes room for
  /// the other's rows.
  virtual Status Yield(const std::string& origin, int64_t seq, Utime now) = 0;
};

}  // namespace beckon::intention
