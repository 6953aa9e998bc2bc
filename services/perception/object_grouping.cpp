// The order of the rules.
#include "services/perception/object_grouping.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "services/perception/fragment_rule.h"
#include "services/perception/grouping_rules.h"
#include "services/perception/neck_rule.h"
#include "services/perception/occlusion_rule.h"
#include "services/perception/vessel_rule.h"

namespace beckon::perception {

PatchGroups::PatchGroups(std::vector<int> group_of_patch) : of_patch_(std::move(group_of_patch)) {
  for (size_t i = 0; i < of_patch_.size(); ++i) {
    if (of_patch_[i] >= Count()) members_.resize(of_patch_[i] + 1);
    members_[of_patch_[i]].push_back(static_cast<int>(i));
  }
}

void PatchGroups::Join(int keep, int gone) {
  if (keep == gone) return;
  for (int patch : members_[gone]) of_patch_[patch] = keep;
  std::vector<int> all;
  std::merge(members_[keep].begin(), members_[keep].end(), members_[gone].begin(),
             members_[gone].end(), std::back_inserter(all));
  members_[keep] = std::move(all);
  members_[gone].clear();
}

Grouping GroupPatches(const PatchScene& scene) {
  std::vector<SignedEdge> evidence;
  evidence.reserve(scene.edges.size());
  const Neighbours neighbours = FindNeighbours(scene.patches, scene.edges);
  for (const PatchEdge& edge : scene.edges) {
    evidence.push_back(LocalEvidence(scene.patches, neighbours, edge));
  }
  std::vector<float> sizes;
  for (const Patch& patch : scene.patches.patches) {
    sizes.push_back(static_cast<float>(patch.n_cells));
  }
  PatchGroups groups(ClusterSignedGraph(sizes, evidence));
  std::vector<Vessel> vessels = JoinInsides(scene, groups);
  JoinNecks(scene, groups);
  JoinAcrossOccluders(scene, groups);
  JoinFragments(scene, groups);
  return {std::move(groups), std::move(vessels)};
}

}  // namespace beckon::perception
