// The counter of a sender's seals: grows with every message, over restarts, and though the clock
// may be put back.
#pragma once

#include <cstdint>
#include <string>

#include "services/base/utime.h"

namespace beckon::trust {

class Counter {
 public:
  /// `file` holds what is reserved; where it cannot be written that is logged once, and the clock
  /// alone has to do.
  explicit Counter(std::string file);

  /// About the microseconds since the epoch, and more than ever before.
  int64_t Next(Utime now);

 private:
  void Reserve();

  const std::string file_;
  int64_t last_ = 0;
  int64_t reserved_ = 0;  // what the file holds: nothing above it was used
  bool complained_ = false;
};

}  // namespace beckon::trust
