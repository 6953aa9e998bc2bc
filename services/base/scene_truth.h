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
  Eigen::Vector3d centroid_C = Eigen::Vector3d::Zero();  // m
};

struct SceneTruth {
  /// False where the source has none (a file without labels); `objects` is empty then.
  bool known = false;
  std::vector<TruthObject> objects;

  /// The object nearest to `p_C`, not farther than `reach_m`; none where there is none.
  std::optional<size_t> Nearest(const Eigen::Vector3d& p_C, double reach_m) const;
  /// Instance 1 of `category`: its object with the smallest horizontal distance from W's origin.
  std::optional<size_t> FirstInstance(const std::string& category, const Pose& X_WC) const;
};

/// How far a segmented object's centroid may lie from its truth's: visible points against visible
/// points.
inline constexpr double kTruthReach_m = 0.06;

/// Reads {"objects": [{"category": "Box", "centroid_C": [x, y, z], ..}, ..] | null}; other keys are
/// left alone. Fails on an unreadable file, text that is not such JSON, and non-finite positions.
Result<SceneTruth> ReadSceneTruth(const std::string& path);

}  // namespace beckon
