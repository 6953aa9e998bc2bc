// `beckon top`: every process on the bus, and the conversations, live in a terminal.
#pragma once

#include <string>

#include "services/base/result.h"
#include "tools/beckon/top_model.h"

namespace beckon::tool {

struct TopOptions {
  bool once = false;
  bool json = false;    // implies once
  double wait_s = 2.5;  // > 0, that `once` listens: rates take two STATUSes, a second apart
};

/// Until `q` or Ctrl-C, or for a moment; 0 then, 1 where a single look heard nobody. Sends nothing.
Result<int> RunTop(const TopOptions& options, const std::string& lcm_url);

}  // namespace beckon::tool
