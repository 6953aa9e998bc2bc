// Keeps a calibration in a file of its own: JSON, replaced in one step.
#pragma once

#include <string>

#include "services/base/result.h"
#include "services/ui_bridge/bci/calibration.h"

namespace beckon::ui_bridge::bci {

/// Name of the file for a user's decoder: what file names may not hold is replaced, and then a
/// checksum keeps different names apart.
std::string CalibrationFileName(const std::string& user, const std::string& decoder,
                                size_t classes);

struct LoadedCalibration {
  Calibration calibration;
  std::string warning;  // of a file that could not be used and was put aside; else empty
};

/// What is there; fresh where nothing is. A file that is torn, or of another decoder, is renamed to
/// `path` + ".bad".
LoadedCalibration LoadCalibration(const std::string& path, size_t classes,
                                  const CalibrationConfig& config);

/// Makes folders that are missing.
Status SaveCalibration(const std::string& path, const Calibration& calibration);

}  // namespace beckon::ui_bridge::bci
