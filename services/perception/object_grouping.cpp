// The order of the rules, and the last one.
#include "services/perception/object_grouping.h"

#include <algorithm>
#include <cmath>
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

namespace {

constexpr float kFloating_m2 = 0.002f;  // larger ones may be objects whose foot is hidden
constexpr double kAboveTable_m = 0.005, kNear_m = 0.03;
constexpr int kSkip = 3;  // of the cells around a patch

double Reach(const Patch& patch) { return 0.5 * std::sqrt(static_cast<double>(patch.area_m2)); }

/// Whether a group is nowhere near the table.
bool IsAboveTable(const PatchScene& scene, const std::vector<int>& members) {
  return std::ranges::all_of(members, [&](int i) {
    const Patch& patch = scene.patches.patches[i];
    return scene.table_C.Distance(patch.centre_C.cast<double>()) - Reach(patch) > kAboveTable_m;
  });
}

/// How far patches a and b are apart, m.
double Gap(const Patch& a, const Patch& b) {
  return static_cast<double>((a.centre_C - b.centre_C).norm()) - Reach(a) - Reach(b);
}

/// The group that is nearest in space to another, by what lies around its patches in the image;
/// -1 = none is near.
int NearestGroup(const PatchScene& scene, const PatchGroups& groups, int g) {
  const auto& patches = scene.patches.patches;
  int nearest = -1;
  double least_m = kNear_m;
  for (int i : groups.Members(g)) {
    const Patch& patch = patches[i];
    const auto around = static_cast<int>((kNear_m + Reach(patch)) * scene.grid.fx /
                                         static_cast<double>(patch.centre_C.z()));
    const int u = static_cast<int>(patch.u), v = static_cast<int>(patch.v);
    for (int y = std::max(0, v - around); y < std::min(scene.grid.height, v + around); y += kSkip) {
      for (int x = std::max(0, u - around); x < std::min(scene.grid.width, u + around);
           x += kSkip) {
        const int other = scene.patches.patch_of_cell[scene.grid.Index(x, y)];
        if (other < 0 || groups.Of(other) == g) continue;
        const double gap_m = Gap(patch, patches[other]);
        if (gap_m < least_m) least_m = gap_m, nearest = groups.Of(other);
      }
    }
  }
  return nearest;
}

}  // namespace

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
  std::vector<std::vector<const PatchEdge*>> edges_of(scene.patches.patches.size());
  for (const PatchEdge& edge : scene.edges) {
    edges_of[edge.a].push_back(&edge);
    edges_of[edge.b].push_back(&edge);
  }
  for (int g : order) {
    if (area[g] >= kFragment_m2) continue;  // grown since
    std::map<int, int> border;
    for (int i : groups.Members(g)) {
      for (const PatchEdge* edge : edges_of[i]) {
        const int other = groups.Of(edge->a == i ? edge->b : edge->a);
        if (other != g) border[other] += edge->n_touching;
      }
    }
    int best = -1, longest = 0;
    for (const auto& [other, n] : border) {
      if (n > longest) longest = n, best = other;
    }
    if (best < 0 && area[g] < kFloating_m2 && IsAboveTable(scene, groups.Members(g))) {
      best = NearestGroup(scene, groups, g);
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
