// `beckon-intention regret`: how much longer the default policy asks than the best possible.
#pragma once

#include <string>

#include "services/base/result.h"
#include "services/intention/core/affordances.h"
#include "services/intention/core/interface.h"

namespace CLI {
class App;
}

namespace beckon::intention {

struct RegretOptions {
  int scenes = 50;  // of each size, distribution and family of questions
  uint64_t seed = 1;
  std::string jsonl;  // output file; empty: none
  Interface interface;
};

/// Declares the subcommand; values land in `options`, which must outlive `app`.
CLI::App* AddRegretCommand(CLI::App& app, RegretOptions& options);

/// Small random scenes against the exact optimum of the same questions, large ones against the best
/// code (of yes/no questions about any set whatever). Prints a table; writes a line a scene.
Status MeasureRegret(const RegretOptions& options, const Affordances& affordances);

}  // namespace beckon::intention
