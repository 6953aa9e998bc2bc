// What is above the table, and what stands on it.
#include "services/perception/object_selection.h"

#include <algorithm>
#include <cmath>

#include "services/perception/table_outline.h"

namespace beckon::perception {
namespace {

constexpr double kAround_m = 0.05;  // of the outline that is looked at too
constexpr double kNearest_m = 0.1;  // what is nearer has no place in the image
// Sides of objects are kept down to this part of min_height_m above the table. Smoothing rounds
// the edges of flat things: half their height is still theirs.
constexpr double kFoot = 0.4;

}  // namespace

CellRectangle SpaceOverTable(const DepthGrid& grid, const Plane& table_C,
                             std::span<const Eigen::Vector3d> hull_C, double max_height_m) {
  const CellRectangle everything{0, 0, grid.width, grid.height};
  Eigen::Vector3d centre(0, 0, 0);
  for (const auto& p : hull_C) centre += p / static_cast<double>(hull_C.size());
  Eigen::AlignedBox2d box;
  for (const auto& p : hull_C) {
    const Eigen::Vector3d low = p + (p - centre).normalized() * kAround_m;
    for (const Eigen::Vector3d& q : {low, Eigen::Vector3d(low + table_C.normal * max_height_m)}) {
      if (q.z() < kNearest_m) return everything;
      box.extend(
          Eigen::Vector2d(q.x() / q.z() * grid.fx + grid.cx, q.y() / q.z() * grid.fy + grid.cy));
    }
  }
  CellRectangle part;
  part.left = static_cast<int>(std::clamp(box.min().x(), 0.0, 1.0 * grid.width));
  part.top = static_cast<int>(std::clamp(box.min().y(), 0.0, 1.0 * grid.height));
  part.right = static_cast<int>(std::clamp(box.max().x() + 1, 0.0, 1.0 * grid.width));
  part.bottom = static_cast<int>(std::clamp(box.max().y() + 1, 0.0, 1.0 * grid.height));
  return part;
}

void MarkAboveTable(const DepthGrid& grid, const std::vector<float>& inverse_depth,
                    const CellRectangle& part, const Plane& table_C,
                    const SegmentationConfig& config, SurfaceCells& cells) {
  const InverseDepthNoise noise(config.sensor);
  cells.used.assign(grid.Size(), 0);
  const Eigen::Vector3f n = table_C.normal.cast<float>();
  const auto d = static_cast<float>(table_C.offset_m);
  const auto least = static_cast<float>(kFoot * config.min_height_m);
  const auto most = static_cast<float>(config.max_height_m);
  CellRectangle found{grid.width, grid.height, 0, 0};
  for (int v = part.top; v < part.bottom; ++v) {
    const float* w = &inverse_depth[grid.Index(0, v)];
    uint8_t* used = &cells.used[grid.Index(0, v)];
    const float facing_0 = n.dot(grid.Ray(0, static_cast<float>(v))), step = n.x() / grid.fx;
    int any = 0;
    for (int u = part.left; u < part.right; ++u) {
      const float facing = facing_0 + step * static_cast<float>(u);  // n · ray
      const float height_w = facing + d * w[u];  // the height above the table, times w
      const float least_w = std::max(least * w[u] * w[u], noise(w[u]) * std::abs(facing));
      used[u] = (w[u] > 0) & (height_w * w[u] > least_w) & (height_w < most * w[u]);
      any |= used[u];
    }
    if (any == 0) continue;
    const uint8_t *first = used + part.left, *last = used + part.right;
    found.left = std::min(found.left, static_cast<int>(std::find(first, last, 1) - used));
    while (last[-1] == 0) --last;
    found.right = std::max(found.right, static_cast<int>(last - used));
    found.top = std::min(found.top, v);
    found.bottom = v + 1;
  }
  cells.part = found.right > 0 ? found : CellRectangle{};
}

std::vector<int> SelectObjects(const PatchScene& scene, const PatchGroups& groups,
                               std::span<const Eigen::Vector2d> outline,
                               const SegmentationConfig& config) {
  const PlaneAxes axes(scene.table_C);
  std::vector<int> objects;
  for (int g = 0; g < groups.Count(); ++g) {
    int n = 0, n_inside = 0;
    double area_m2 = 0, top_m = 0;
    for (int i : groups.Members(g)) {
      const Patch& patch = scene.patches.patches[i];
      const Eigen::Vector3d centre = patch.centre_C.cast<double>();
      n += patch.n_cells;
      area_m2 += patch.seen_m2;
      top_m = std::max(top_m, scene.table_C.Distance(centre));
      if (DepthInside(outline, axes(centre)) > config.border_m) n_inside += patch.n_cells;
    }
    if (area_m2 > config.min_object_m2 && top_m > config.min_height_m && n_inside * 5 >= n) {
      objects.push_back(g);
    }
  }
  return objects;
}

}  // namespace beckon::perception
