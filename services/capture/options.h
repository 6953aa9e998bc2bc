// What beckon-capture is told on its command line and in its configuration file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/base/config.h"
#include "services/base/geometry.h"

namespace CLI {
class App;
}

namespace beckon::capture {

struct Options {
  std::string input;  // file or folder; empty = the embedded scene
  uint64_t embedded_seed = 1;
  double rate_hz = 2;              // 0.01 .. 60
  bool once = false;               // a folder: stop after its last file
  std::vector<double> intrinsics;  // fx fy cx cy in px, or empty: told from the file
  std::string truth;               // write the ground truth there and end

  bool render = false;          // offline: frames of the embedded scene
  bool render_objects = false;  // offline: single objects
  uint64_t seed = 1;
  int frames = 1;
  int per_category = 90;
  int views = 2;               // of each object
  std::string sensor = "any";  // or "kinect"
  std::string meshes;          // folder of a lab's own meshes
  std::string out;
};

void AddOptions(CLI::App& app, Options& options);

/// Reads `input`, `embedded_seed`, `rate_hz`, `once` and `intrinsics` from the file; flags win.
Status ReadConfig(const CLI::App& app, ConfigTable& config, Options& options);

/// Refuses values out of range and flags that do not go together.
Status Check(const CLI::App& app, const Options& options);

/// The camera of `options.intrinsics`, where it was given.
std::optional<Intrinsics> GivenIntrinsics(const Options& options);

}  // namespace beckon::capture
