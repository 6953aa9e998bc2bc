// The order of the rules, and the last one.
#include "services/perception/object_grouping.h"

#include <algorithm>
#include <map>

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

void PatchGroups::Move(int patch, int group) {
  auto& from = members_[of_patch_[patch]];
  from.erase(std::lower_bound(from.begin(), from.end(), patch));
  auto& to = members_[group];
  to.insert(std::lower_bound(to.begin(), to.end(), patch), patch);
  of_patch_[patch] = group;
}

void JoinFragments(const PatchScene& scene, PatchGroups& groups) {
  std::vector<float> area(groups.Count(), 0);
  for (size_t i = 0; i < scene.patches.patches.size(); ++i) {
    area[groups.Of(static_cast<int>(i))] += scene.patches.patches[i].area_m2;
  }
  std::vector<int> order;
  for (int g = 0; g < groups.Count(); ++g) {
    if (!groups.Members(g).empty() && area[g] < kFragment_m2) order.push_back(g);
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return area[a] < area[b]; });
  for (int g : order) {
    if (area[g] >= kFragment_m2) continue;  // grown since
    std::map<int, int> border;
    for (const PatchEdge& edge : scene.edges) {
      const int a = groups.Of(edge.a), b = groups.Of(edge.b);
      if ((a == g) != (b == g)) border[a == g ? b : a] += edge.n_touching;
    }
    int best = -1, longest = 0;
    for (const auto& [other, n] : border) {
      if (n > longest) longest = n, best = other;
    }
    if (best < 0) continue;
    groups.Join(best, g);
    area[best] += area[g];
  }
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
