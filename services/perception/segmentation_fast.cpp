// The steps of fast segmentation, one after the other.
#include "services/perception/segmentation_fast.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "services/perception/object_grouping.h"
#include "services/perception/label_pixels.h"
#include "services/perception/surface_patches.h"
#include "services/perception/table_outline.h"
#include "services/perception/table_planes.h"

namespace beckon::perception {
namespace {

/// Marks the cells above the table and finds the rectangle that holds them.
void MarkAbove(const DepthGrid& grid, const std::vector<float>& inverse, const Plane& table_C,
               const SegmentationConfig& config, SurfaceCells& cells) {
  const InverseDepthNoise noise(config.sensor);
  cells.used.assign(grid.Size(), 0);
  const auto n = table_C.normal.cast<float>().eval();
  const auto d = static_cast<float>(table_C.offset_m), most = static_cast<float>(config.max_height_m);
  const float least = std::min(static_cast<float>(config.min_height_m), 0.004f);
  CellRectangle part{grid.width, grid.height, 0, 0};
  for (int v = 0; v < grid.height; ++v) {
    const size_t row = grid.Index(0, v);
    int first = grid.width, last = -1;
    for (int u = 0; u < grid.width; ++u) {
      const float w = inverse[row + u];
      const float facing = n.dot(grid.Ray(static_cast<float>(u), static_cast<float>(v)));
      const float height_w = facing + d * w;  // height above the table times w
      const float low = std::max(least * w, 1.0f * noise(w) * std::abs(facing) / w);
      const bool above = (w > 0) & (height_w > low) & (height_w < most * w);
      cells.used[row + u] = above;
      if (above) first = std::min(first, u), last = u;
    }
    if (last < 0) continue;
    part.left = std::min(part.left, first), part.right = std::max(part.right, last + 1);
    part.top = std::min(part.top, v), part.bottom = v + 1;
  }
  if (part.right == 0) part = {};
  cells.part = part;
}

}  // namespace

Segmentation SegmentFast(const RgbdImage& image, const SegmentationConfig& config,
                         const StepObserver& done) {
  auto finished = [&done](const char* step) {
    if (done) done(step);
  };
  Segmentation result;
  const DepthGrid grid =
      MakeDepthGrid(image, config.fast_min_range_m, config.max_range_m, config.sensor);
  result.n_points = grid.n_pixels;
  finished("grid");
  const TablePlane table = FindTablePlane(grid, config);
  finished("table");
  if (!table.table_C) {
    result.reason = table.reason;
    result.labels.assign(image.depth_m.size(), 0);
    return result;
  }
  result.table_C = table.table_C;
  const PlaneAxes axes(*table.table_C);
  for (const auto& p : table.outline) {
    result.hull_C.push_back(axes.x * p.x() + axes.y * p.y() -
                            table.table_C->normal * table.table_C->offset_m);
  }

  SurfaceCells cells;
  MarkAbove(grid, grid.inverse_depth, *table.table_C, config, cells);
  cells.inverse_depth = SmoothInverseDepth(grid, cells.part, config.sensor);
  MarkAbove(grid, cells.inverse_depth, *table.table_C, config, cells);
  finished("smooth");
  EstimateNormals(grid, config.sensor, cells);
  finished("normals");
  SurfacePatches patches = MakePatches(grid, cells, config.sensor);
  finished("patches");
  const auto edges = FindEdges(grid, cells, patches, config.sensor);
  SteadyNormals(edges, patches);
  finished("edges");
  const PatchGroups groups = GroupPatches({grid, cells, patches, edges, *table.table_C, config.sensor});
  std::vector<int> group(patches.patches.size());
  for (size_t i = 0; i < group.size(); ++i) group[i] = groups.Of(i);
  int n_groups = 0;
  for (int g : group) n_groups = std::max(n_groups, g + 1);
  struct Sum { int n = 0, inside = 0; float area = 0, top = 0; };
  std::vector<Sum> sums(n_groups);
  for (size_t k = 0; k < group.size(); ++k) {
    auto& s = sums[group[k]];
    const Patch& p = patches.patches[k];
    s.n += p.n_cells, s.area += p.area_m2;
    const Eigen::Vector3d c = p.centre_C.cast<double>();
    s.top = std::max(s.top, (float)table.table_C->Distance(c));
    if (DepthInside(table.outline, axes(c)) > config.border_m) s.inside += p.n_cells;
  }
  std::vector<int> order;
  for (int g = 0; g < n_groups; ++g) if (sums[g].area > 0.0004f && sums[g].inside * 5 > sums[g].n && sums[g].top > config.min_height_m) order.push_back(g);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return sums[a].n > sums[b].n; });
  std::vector<uint16_t> label(n_groups, 0), label_of_cell(grid.Size(), 0);
  for (size_t i = 0; i < order.size() && i < (size_t)config.max_objects; ++i) label[order[i]] = i + 1;
  for (size_t i = 0; i < label_of_cell.size(); ++i) if (patches.patch_of_cell[i] >= 0) label_of_cell[i] = label[group[patches.patch_of_cell[i]]];
  finished("grouping");
  result.n_objects = std::min<int>(order.size(), config.max_objects);
  result.labels = LabelPixels(image, grid, cells, label_of_cell, config.sensor);
  finished("labels");
  return result;
}

}  // namespace beckon::perception
