// A database that is damaged does not keep the service from starting.
#pragma once

#include <memory>
#include <string>

#include "services/intention/store.h"

namespace beckon::intention {

struct OpenedStore {
  std::unique_ptr<Store> store;
  std::string notice;  // what a person should know; empty: nothing
};

/// As Store::Open to write. A damaged database is put aside as `<path>.damaged-<now>`, and a
/// fresh one begins under a new origin with all rows that can still be read and whose checksum is
/// right; other machines send the rest. Everything counts as stopped if the damaged one cannot say
/// that it is not.
Result<OpenedStore> OpenOrReplace(const std::string& path, const std::string& machine, Utime now);

}  // namespace beckon::intention
