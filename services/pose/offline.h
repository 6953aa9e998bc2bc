// The offline mode: clouds from files, poses to files.
#pragma once

#include <string>
#include <vector>

#include "services/base/result.h"
#include "services/pose/estimate.h"

namespace beckon::pose {

struct OfflineOptions {
  std::vector<std::string> inputs;
  std::string labels;  // 16-bit PNG of the only, organised input's objects; empty: it is one object
  std::string plane;   // "nx,ny,nz,d" of all inputs; empty: none
  std::string list;    // instead of inputs
  std::string json;    // output
  std::string picture;  // output; empty: none
  std::string mesh;     // output; empty: none
  int repeat = 1;       // times each cloud is estimated; the median time is told
};

/// Estimates every cloud, or every labelled object of one, and writes the results. Fails on the
/// first input that cannot be read.
Status RunOffline(const OfflineOptions& options, const PoseConfig& config);

}  // namespace beckon::pose
