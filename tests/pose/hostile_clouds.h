// Clouds, tables, viewpoints and rims as they should not be, and what any estimate of them must be.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "services/pose/estimate.h"
#include "tests/draws.h"

namespace beckon::pose {

struct HostileCloud {
  std::vector<Eigen::Vector3f> points;
  std::optional<Plane> table;
  Eigen::Vector3d viewpoint = Eigen::Vector3d::Zero();
  std::vector<RimPoint> rim;
  bool hopeless = false;  // must not converge

  FitInput input() const { return {points, table, viewpoint, rim}; }
};

/// A view of a box or a can on a table, some hundred points, and its rim.
HostileCloud SoundCloud(Draws& draws);

/// What can be done to a sound cloud, by name; it has points and a table before.
using Damage = std::function<void(HostileCloud&, Draws&)>;
const std::vector<std::pair<const char*, Damage>>& Damages();

/// What is wrong with an estimate, whatever it is of; empty where nothing is.
std::string Unsound(const FitResult& fit);
std::string Unsound(const Estimate& estimate);

}  // namespace beckon::pose
