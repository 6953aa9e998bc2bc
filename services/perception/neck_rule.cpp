// A slim group on the axis of the body below it.
#include "services/perception/neck_rule.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "services/perception/revolution_wall.h"

namespace beckon::perception {
namespace {

constexpr double kSlim = 0.75;        // of the body's radius
constexpr double kSlim_m = 0.03;      // largest radius of a neck
constexpr double kOffAxis_m = 0.006;  // beside the axis, as the camera sees it
constexpr int kLeastTouching = 2;     // cells along which they touch
constexpr size_t kFewestPatches = 5;  // of a body

/// Mean distance of patches to the right of an axis as seen from the camera, m; all of them must
/// lie within `radius_m` of it, above `height_m`.
bool OnAxis(const PatchScene& scene, const PlaneAxes& axes, const Eigen::Vector2d& axis,
            const std::vector<int>& members, double radius_m, double height_m) {
  const Eigen::Vector2d away = axis.normalized();  // the camera is above the origin of the axes
  const Eigen::Vector2d right(-away.y(), away.x());
  double sum = 0, weight = 0;
  for (int i : members) {
    const Patch& patch = scene.patches.patches[i];
    const Eigen::Vector3d p = patch.centre_C.cast<double>();
    const Eigen::Vector2d off = axes(p) - axis;
    if (off.norm() > radius_m || scene.table_C.Distance(p) < height_m) return false;
    sum += patch.n_cells * right.dot(off);
    weight += patch.n_cells;
  }
  return std::abs(sum / weight) < kOffAxis_m;
}

}  // namespace

void JoinNecks(const PatchScene& scene, PatchGroups& groups) {
  const PlaneAxes axes(scene.table_C);
  std::map<std::pair<int, int>, int> touching;
  for (const PatchEdge& edge : scene.edges) {
    const int a = groups.Of(edge.a), b = groups.Of(edge.b);
    if (a == b || edge.n_touching == 0) continue;
    touching[{a, b}] += edge.n_touching;
    touching[{b, a}] += edge.n_touching;
  }
  std::map<int, std::optional<Wall>> walls;
  for (const auto& [pair, n] : touching) {
    const auto [body, neck] = pair;
    if (n < kLeastTouching || groups.Members(body).size() < kFewestPatches ||
        groups.Members(neck).empty() || groups.Members(neck).size() > groups.Members(body).size()) {
      continue;
    }
    if (!walls.contains(body)) walls[body] = FitWall(scene, axes, groups.Members(body));
    const auto& wall = walls[body];
    if (!wall) continue;
    const double middle_m = wall->rim_height_m / 2;
    const double radius_m = std::min(kSlim_m, kSlim * wall->Radius(middle_m));
    if (OnAxis(scene, axes, wall->centre, groups.Members(neck), radius_m, middle_m)) {
      groups.Join(body, neck);
    }
  }
}

}  // namespace beckon::perception
