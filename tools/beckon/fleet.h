// How the five services are started for one conversation on one machine.
#pragma once

#include <string>
#include <vector>

#include "tools/beckon/child_process.h"

namespace beckon::tool {

struct FleetConfig {
  std::string bin_dir;  // of the programs
  std::string run_dir;  // logs, and what else the run leaves
  std::string lcm_url;
  std::string input;  // file for capture; empty = the embedded scene
  int seed = 1;       // of the embedded scene
  std::string db;     // of intention; perception keeps what it is told in ExamplesFolder()
  std::string perception_config;  // file; empty = its defaults
  std::string policy;             // of intention; empty = its default
  std::string user;
  int sessions = 0;      // 0 = until the user leaves
  double think_s = 0;    // of the simulated user
  double flip = 0;       // of the simulated user
  int page_socket = -1;  // on which ui_bridge serves the page; -1 = none

  std::string TruthFile() const { return run_dir + "/truth.json"; }
  /// Beside the database.
  std::string ExamplesFolder() const { return db + ".examples"; }
};

/// Capture, publishing.
ProcessSpec CaptureSpec(const FleetConfig& config);
/// Capture, writing the input's ground truth to TruthFile() and leaving.
ProcessSpec TruthSpec(const FleetConfig& config);
ProcessSpec PerceptionSpec(const FleetConfig& config);
ProcessSpec PoseSpec(const FleetConfig& config);
ProcessSpec IntentionSpec(const FleetConfig& config);
/// `want` is for the simulated front end alone; `terminal`: it has this process's terminal.
ProcessSpec UiBridgeSpec(const FleetConfig& config, const std::vector<std::string>& front_ends,
                         const std::string& want, bool terminal);
/// Stock lcm-logger, writing all of the bus to `log`.
ProcessSpec LoggerSpec(const FleetConfig& config, const std::string& log);

/// The folder this program is in.
std::string OwnBinDir();

}  // namespace beckon::tool
