// What the rim of a wall shows.
#include "services/perception/vessel_rule.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace beckon::perception {
namespace {

constexpr double kTolerance_m = 0.006;
constexpr double kUpright = 0.5;       // least height of the normal of a bottom
constexpr double kBelowFoot_m = 0.02;  // of a patch on the wall: a patch is as wide
constexpr double kThickWall_m = 0.01, kThickWall = 0.12;  // and a part of the radius

/// Whether the camera sees a place below the rim through the rim.
bool IsSeenThroughRim(const PatchScene& scene, const PlaneAxes& axes, const Wall& wall,
                      const Eigen::Vector3d& p, double height_m) {
  const double camera_m = scene.table_C.offset_m;
  if (camera_m <= wall.rim_height_m || height_m >= camera_m) return false;
  const double part = (camera_m - wall.rim_height_m) / (camera_m - height_m);
  const double from_axis_m = (axes(p * std::min(part, 1.0)) - wall.centre).norm();
  return from_axis_m < wall.Radius(wall.rim_height_m) + kTolerance_m;
}

/// Whether a patch lies on the wall, or is seen through the rim on the wall's inside or the bottom.
bool IsWithin(const PatchScene& scene, const PlaneAxes& axes, const Wall& wall,
              const Patch& patch) {
  const Eigen::Vector3d p = patch.centre_C.cast<double>();
  const double height_m = scene.table_C.Distance(p);
  if (height_m > wall.rim_height_m + kTolerance_m) return false;
  const double outside_m = (axes(p) - wall.centre).norm() - wall.Radius(height_m);
  if (outside_m > kTolerance_m) return false;
  if (height_m > wall.foot_height_m - kBelowFoot_m && -outside_m < kTolerance_m) return true;
  const double slope = patch.normal_C.cast<double>().dot(scene.table_C.normal);
  const double thick_m = kThickWall_m + kThickWall * wall.Radius(wall.rim_height_m);
  return (slope > kUpright || -outside_m < thick_m) &&
         IsSeenThroughRim(scene, axes, wall, p, height_m);
}

/// Joins to group g what lies within its wall. Returns whether anything does.
bool JoinWithin(const PatchScene& scene, const PlaneAxes& axes, const Wall& wall, int g,
                PatchGroups& groups) {
  std::vector<int> n_inside(groups.Count(), 0);
  for (size_t i = 0; i < scene.patches.patches.size(); ++i) {
    n_inside[groups.Of(static_cast<int>(i))] +=
        IsWithin(scene, axes, wall, scene.patches.patches[i]);
  }
  bool any = false;
  for (int other = 0; other < groups.Count(); ++other) {
    const auto n = static_cast<int>(groups.Members(other).size());
    if (other == g || n == 0 || n_inside[other] * 10 < n * 8) continue;
    groups.Join(g, other);
    any = true;
  }
  return any;
}

/// The pairs of groups that touch, each once.
std::vector<std::pair<int, int>> TouchingGroups(const PatchScene& scene,
                                                const PatchGroups& groups) {
  std::vector<std::pair<int, int>> pairs;
  for (const PatchEdge& edge : scene.edges) {
    const int a = groups.Of(edge.a), b = groups.Of(edge.b);
    if (a != b && edge.n_touching >= 2) pairs.emplace_back(std::min(a, b), std::max(a, b));
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

/// The inside that two groups make together.
std::optional<Wall> CommonInside(const PatchScene& scene, const PlaneAxes& axes,
                                 const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> both;
  std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  auto wall = FitWall(scene, axes, both);
  const bool fits =
      wall && wall->is_inside && LiesOn(scene, axes, *wall, a) && LiesOn(scene, axes, *wall, b);
  return fits ? wall : std::nullopt;
}

}  // namespace

std::vector<Vessel> JoinInsides(const PatchScene& scene, PatchGroups& groups) {
  const PlaneAxes axes(scene.table_C);
  std::vector<Vessel> vessels;
  for (const auto& [a, b] : TouchingGroups(scene, groups)) {
    if (groups.Members(a).empty() || groups.Members(b).empty()) continue;
    const auto wall = CommonInside(scene, axes, groups.Members(a), groups.Members(b));
    if (!wall) continue;
    groups.Join(a, b);
    JoinWithin(scene, axes, *wall, a, groups);
    vessels.push_back({groups.Members(a).front(), *wall});
  }
  std::vector<int> order;
  for (int g = 0; g < groups.Count(); ++g) order.push_back(g);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return groups.Members(a).size() > groups.Members(b).size();
  });
  for (int g : order) {
    const auto wall = FitWall(scene, axes, groups.Members(g));
    if (!wall) continue;
    const int patch = groups.Members(g).front();
    if (JoinWithin(scene, axes, *wall, g, groups)) vessels.push_back({patch, *wall});
  }
  return vessels;
}

bool IsBottom(const PatchScene& scene, const PlaneAxes& axes, const Vessel& vessel,
              const Eigen::Vector3d& p) {
  const Wall& wall = vessel.wall;
  const double from_axis_m = (axes(p) - wall.centre).norm();
  return from_axis_m < wall.Radius(wall.foot_height_m) - kTolerance_m &&
         IsSeenThroughRim(scene, axes, wall, p, scene.table_C.Distance(p));
}

}  // namespace beckon::perception
