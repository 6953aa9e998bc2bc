// A row of the shared history, and the checksums by which machines compare what they have.
#pragma once

#include <cstdint>
#include <string>

#include "services/base/utime.h"

namespace beckon::intention {

/// A row of the append-only history as it is exported, imported and shared.
struct HistoryRow {
  std::string origin;  // that numbered it
  int64_t seq = 0;     // 1, 2, 3, ... without gaps in each origin
  std::string kind;    // session, label, forget, erased, or of a newer version
  std::string body;    // JSON
  /// Hybrid logical time [us]: no earlier than its writer's clock, and later than all that its
  /// writer knew of. 0: not said (exports of older versions), the time in the body counts.
  Utime hybrid_utime = 0;
};

/// Over every field. Not cryptographic: it finds damage and forks, not malice.
uint64_t RowHash(const HistoryRow& row);

/// The checksum of rows 1 .. n out of that of 1 .. n-1 (0 of no rows) and row n's hash.
uint64_t ExtendChain(uint64_t chain, uint64_t row_hash);

/// The rows 1 .. seq of an origin.
struct HistoryHead {
  int64_t seq = 0;
  uint64_t chain = 0;
  bool operator==(const HistoryHead&) const = default;
};

}  // namespace beckon::intention
