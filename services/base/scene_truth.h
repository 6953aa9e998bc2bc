// Ground truth of a scene, as capture writes it beside what it renders and as simulated users and
// judges read it: which object of which category stands where.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/base/geometry.h"
#include "services/base/result.h"

namespace beckon {

struct TruthObject {
  std::string category;
  Eigen::Vector3d centroid_C = Eigen::Vector3d::Zero();  // m, of the visible points
  Eigen::AlignedBox3d box_C;  // m, of the visible points; empty where unknown
};

struct SceneTruth {
  /// False where the source has none (a file without labels); `objects` is empty then.
  bool known = false;
  std::vector<TruthObject> objects;

  /// The object that a segment with the centroid `p_C` shows (the whole of it, or a part where an
  /// occluder or a rim cut it in two): its box holds `p_C` within 2 cm, or where it has none its
  /// centroid lies within 6 cm; of several the one with the nearest centroid.
  std::optional<size_t> At(const Eigen::Vector3d& p_C) const;
  /// Instance 1 of `category`: its object with the smallest horizontal distance from W's origin.
  std::optional<size_t> FirstInstance(const std::string& category, const Pose& X_WC) const;
};

/// Reads {"objects": [{"category": "Box", "centroid_C": [x, y, z], ..}, ..] | null}, with an
/// optional "box_C": {"min": [x, y, z], "max": [..]} an object; other keys are left alone. Fails on
/// an unreadable file, text that is not such JSON, and non-finite positions.
Result<SceneTruth> ReadSceneTruth(const std::string& path);

}  // namespace beckon
