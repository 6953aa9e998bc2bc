// Between SQLite's exceptions and Result; for the store's own files only.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include "services/intention/store.h"
#include "services/intention/store_schema.h"

namespace beckon::intention {

template <typename T, typename Work>
Result<T> Store::Try(Work work) {
  try {
    return work();
  } catch (const SQLite::Exception& e) {
    return Explain(e, path_);
  }
}

}  // namespace beckon::intention
