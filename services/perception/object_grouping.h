// From patches to objects: the rules in their order.
#pragma once

#include <vector>

#include "services/perception/patch_graph.h"

namespace beckon::perception {

/// What a rule may look at.
struct PatchScene {
  const DepthGrid& grid;
  const SurfaceCells& cells;
  const SurfacePatches& patches;
  const std::vector<PatchEdge>& edges;
  const Plane& table_C;
  const SensorNoise& sensor;
};

/// Sets of patches that are thought to be of one object; rules join them.
class PatchGroups {
 public:
  explicit PatchGroups(std::vector<int> group_of_patch);

  int Of(int patch) const { return of_patch_[patch]; }
  int Count() const { return static_cast<int>(members_.size()); }
  /// Patches of a group, ascending; empty once it was joined to another.
  const std::vector<int>& Members(int group) const { return members_[group]; }
  /// Puts all of `gone` into `keep`.
  void Join(int keep, int gone);

 private:
  std::vector<int> of_patch_;
  std::vector<std::vector<int>> members_;
};

/// An upright round vessel; see vessel_rule.h.
struct Vessel;

struct Grouping {
  PatchGroups groups;
  std::vector<Vessel> vessels;
};

/// The object of each patch, in five steps: local evidence (grouping_rules.h), insides to their
/// vessels (vessel_rule.h), necks to their bottles (neck_rule.h), what an occluder cut apart
/// (occlusion_rule.h), fragments to what they touch or hang on
/// (fragment_rule.h).
Grouping GroupPatches(const PatchScene& scene);

}  // namespace beckon::perception
