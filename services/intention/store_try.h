// Between SQLite's exceptions and Result; for the store's own files only.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include "services/intention/store.h"
#include "services/intention/store_schema.h"

namespace beckon::intention {

inline constexpr auto kImmediate = SQLite::TransactionBehavior::IMMEDIATE;

/// Of a query for origin, seq, kind, body, hybrid_utime.
inline HistoryRow RowFrom(SQLite::Statement& query) {
  return {query.getColumn(0).getString(), query.getColumn(1).getInt64(),
          query.getColumn(2).getString(), query.getColumn(3).getString(),
          query.getColumn(4).getInt64()};
}

template <typename T, typename Work>
Result<T> Store::Try(Work work) {
  try {
    return work();
  } catch (const SQLite::Exception& e) {
    return Explain(e, path_);
  }
}

}  // namespace beckon::intention
