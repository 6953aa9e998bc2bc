// `beckon-intention simulate`: scenarios of made-up users.
#pragma once

#include <string>

#include "services/intention/core/simulated_user.h"

namespace CLI {
class App;
}

namespace beckon::intention {

struct SimulateOptions {
  SimulationConfig simulation;
  std::string out;  // scenario file (docs/formats.md)
};

/// Declares the subcommand; values land in `options`, which must outlive `app`.
CLI::App* AddSimulateCommand(CLI::App& app, SimulateOptions& options);

/// Writes a session a line; "utime" only where the kind of user lives by the clock.
Status WriteSimulated(const SimulateOptions& options, const Affordances& affordances);

}  // namespace beckon::intention
