// The settings of the front end bci, as its section [bci] of the configuration file gives them.
#pragma once

#include <string>

#include "services/base/config.h"
#include "services/base/result.h"
#include "services/ui_bridge/bci/calibration.h"
#include "services/ui_bridge/bci/trials.h"

namespace beckon::ui_bridge::bci {

struct BciConfig {
  TrialsConfig trials;
  CalibrationConfig calibration;
  double trial_s = 3;           // s, of a trial as expected; measured once trials run
  bool learn = true;            // calibrate by confirmed sessions
  std::string calibration_dir;  // empty: DataFile("bci")
  std::string lsl;              // name of an LSL stream of probabilities; empty: none
  std::string lsl_library;      // empty: liblsl.so.2, then liblsl.so
};

/// Reads each key that is there; what is wrong is recorded in `table`.
void ReadConfig(ConfigTable table, BciConfig& config);

}  // namespace beckon::ui_bridge::bci
