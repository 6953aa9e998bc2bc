// `beckon run PROFILE`: the processes a machine is to run, kept running.
#pragma once

#include <string>
#include <vector>

#include "services/base/result.h"
#include "tools/beckon/child_process.h"

namespace beckon::tool {

struct Profile {
  std::string lcm_url;  // empty = as on the command line
  std::string logs;     // folder; empty = $XDG_STATE_HOME/beckon or ~/.local/state/beckon
  std::vector<ProcessSpec> processes;
};

/// Reads
///   lcm_url = "udpm://.."      # optional
///   logs = "/var/log/beckon"   # optional
///   [process.NAME]
///   program = "beckon-pose"    # a path, or a name: beside this program, else in $PATH
///   args = ["--verbose"]       # optional
///   terminal = false           # optional: has the terminal, at most one
/// where `path` is a file, or the name of a profile that ships with Beckon ("one-machine",
/// "two-machines/room").
Result<Profile> LoadProfile(const std::string& path);

/// Runs it until Ctrl-C or SIGTERM; 0 then. `lcm_url` is for profiles that name none.
Result<int> RunProfile(const std::string& path, const std::string& lcm_url);

}  // namespace beckon::tool
