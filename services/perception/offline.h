// Perceives a file without a bus: a cloud in, JSON and pictures out.
#pragma once

#include <string>

#include "services/perception/perception_config.h"

namespace beckon::perception {

struct OfflineOptions {
  std::string input;         // .pcd or .ply, organised or not
  std::string json_file;     // empty: standard output
  std::string labels_file;   // empty: none
  std::string picture_file;  // empty: none
  std::string stage;         // of segmentation, that the picture shows; empty: the result
  int repeat = 1;            // times everything is computed; the medians of the times are told
};

/// Fails on files that cannot be read or written. A scene without a table is no failure.
Status PerceiveFile(const OfflineOptions& options, const PerceptionConfig& config);

/// Prints the names of the configured model's categories, one a line; nothing where categories are
/// off.
Status ListCategories(const PerceptionConfig& config);

/// What the JSON says: {"table": {"normal", "offset_m"} | null, "reason", "objects": [..],
/// "timing_ms": {..}, "steps_ms": {..}}; "reason" only where there is no table.
std::string ToJson(const Perception& perception);

}  // namespace beckon::perception
