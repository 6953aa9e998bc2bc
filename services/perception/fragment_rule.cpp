// Small groups go to what they touch most, or hang on.
#include "services/perception/fragment_rule.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace beckon::perception {
namespace {

constexpr float kFragment_m2 = 0.003f;
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

}  // namespace beckon::perception
