// The steps of fast segmentation, one after the other.
#include "services/perception/segmentation_fast.h"

#include <algorithm>
#include <sstream>

#include "services/perception/depth_smoothing.h"
#include "services/perception/label_pixels.h"
#include "services/perception/object_grouping.h"
#include "services/perception/object_selection.h"
#include "services/perception/surface_patches.h"
#include "services/perception/table_outline.h"
#include "services/perception/table_planes.h"
#include "services/perception/vessel_rule.h"

namespace beckon::perception {
namespace {

std::string TooFewPoints(const DepthGrid& grid, const SegmentationConfig& config) {
  std::ostringstream text;
  text << "only " << grid.n_pixels << " pixels have depth between " << config.min_range_m << " and "
       << config.max_range_m << " m, too few for a table";
  return text.str();
}

/// A number for each cell.
template <typename Number>
std::vector<uint32_t> OfCells(const DepthGrid& grid, Number number) {
  std::vector<uint32_t> of_cells(grid.Size());
  for (size_t i = 0; i < of_cells.size(); ++i) of_cells[i] = static_cast<uint32_t>(number(i));
  return of_cells;
}

/// Bands of equal inverse depth, which follow the sensor's steps; 0 = no depth.
int DepthBand(const DepthGrid& grid, size_t cell) {
  constexpr float kBands = 25;  // per 1/m: a band is 4 cm deep at 1 m
  const float w = grid.inverse_depth[cell];
  return w > 0 ? 1 + static_cast<int>(kBands * w) : 0;
}

/// Takes the found table into the result.
void TellTable(const TablePlane& table, Segmentation& result) {
  result.table_C = table.table_C;
  result.reason = table.reason;
  result.n_table_points = table.n_pixels;
  if (!table.table_C) return;
  const PlaneAxes axes(*table.table_C);
  for (const auto& p : table.outline) {
    result.hull_C.push_back(axes.x * p.x() + axes.y * p.y() -
                            table.table_C->normal * table.table_C->offset_m);
  }
}

/// The label of each cell's group; 0 = none.
std::vector<uint16_t> LabelCells(const SurfacePatches& patches, const PatchGroups& groups,
                                 const std::vector<uint16_t>& label_of_group) {
  std::vector<uint16_t> label_of_cell(patches.patch_of_cell.size(), 0);
  for (size_t i = 0; i < label_of_cell.size(); ++i) {
    const int patch = patches.patch_of_cell[i];
    if (patch >= 0) label_of_cell[i] = label_of_group[groups.Of(patch)];
  }
  return label_of_cell;
}

/// The rectangle that the centres of patches span.
CellRectangle PartOf(const PatchScene& scene, const std::vector<int>& members) {
  CellRectangle part{scene.grid.width, scene.grid.height, 0, 0};
  for (int i : members) {
    const Patch& patch = scene.patches.patches[i];
    part.left = std::min(part.left, static_cast<int>(patch.u));
    part.top = std::min(part.top, static_cast<int>(patch.v));
    part.right = std::max(part.right, static_cast<int>(patch.u) + 1);
    part.bottom = std::max(part.bottom, static_cast<int>(patch.v) + 1);
  }
  return part;
}

/// Gives the bottoms of vessels, which are too near the table to be surface cells, to the vessels:
/// they are seen between cells of theirs.
void LabelBottoms(const PatchScene& scene, const PatchGroups& groups,
                  const std::vector<Vessel>& vessels, const std::vector<uint16_t>& label_of_group,
                  std::vector<uint16_t>& label_of_cell) {
  const PlaneAxes axes(scene.table_C);
  for (const Vessel& vessel : vessels) {
    const int group = groups.Of(vessel.patch);
    const CellRectangle part = PartOf(scene, groups.Members(group));
    const uint16_t label = label_of_group[group];
    for (int v = part.top; v < part.bottom; ++v) {
      for (int u = part.left; u < part.right; ++u) {
        const size_t i = scene.grid.Index(u, v);
        const float w = scene.cells.inverse_depth[i];
        if (w <= 0 || scene.cells.used[i]) continue;
        const Eigen::Vector3f p = scene.grid.Point(static_cast<float>(u), static_cast<float>(v), w);
        if (IsBottom(scene, axes, vessel, p.cast<double>())) label_of_cell[i] = label;
      }
    }
  }
}

/// Numbers the objects anew, the one with most pixels first, and keeps the first `most`.
void NumberBySize(int n_labels, int most, Segmentation& result) {
  std::vector<int> n_pixels(n_labels + 1, 0);
  for (uint16_t label : result.labels) ++n_pixels[label];
  std::vector<int> order;
  for (int k = 1; k <= n_labels; ++k) {
    if (n_pixels[k] > 0) order.push_back(k);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return n_pixels[a] > n_pixels[b]; });
  result.n_objects = std::min(static_cast<int>(order.size()), most);
  result.n_left_out = static_cast<int>(order.size()) - result.n_objects;
  std::vector<uint16_t> number(n_labels + 1, 0);
  for (int k = 0; k < result.n_objects; ++k) number[order[k]] = static_cast<uint16_t>(k + 1);
  for (uint16_t& label : result.labels) label = number[label];
}

}  // namespace

Segmentation SegmentFast(const RgbdImage& image, const SegmentationConfig& config,
                         const StepObserver& done) {
  int cell_px = 1;
  auto finished = [&](const char* step, std::function<std::vector<uint32_t>()> regions = {}) {
    if (done) done({step, cell_px, std::move(regions)});
  };
  Segmentation result;
  result.labels.assign(image.depth_m.size(), 0);
  const DepthGrid grid =
      MakeDepthGrid(image, config.min_range_m, config.max_range_m, config.sensor);
  result.n_points = grid.n_pixels;
  cell_px = grid.pixels;
  finished("grid", [&] { return OfCells(grid, [&](size_t i) { return DepthBand(grid, i); }); });
  if (grid.n_pixels < config.plane_min_points) {
    result.reason = TooFewPoints(grid, config);
    return result;
  }
  const TablePlane table = FindTablePlane(grid, config);
  TellTable(table, result);
  finished("table");
  if (!table.table_C) return result;

  const CellRectangle space =
      SpaceOverTable(grid, *table.table_C, result.hull_C, config.max_height_m);
  SurfaceCells cells;
  MarkAboveTable(grid, grid.inverse_depth, space, *table.table_C, config, cells);
  cells.inverse_depth = SmoothInverseDepth(grid, cells.part, config.sensor);
  MarkAboveTable(grid, cells.inverse_depth, space, *table.table_C, config, cells);
  EstimateNormals(grid, config.sensor, cells);
  finished("surface", [&] { return OfCells(grid, [&](size_t i) { return cells.used[i]; }); });
  SurfacePatches patches = MakePatches(grid, cells, config.sensor);
  finished("patches",
           [&] { return OfCells(grid, [&](size_t i) { return patches.patch_of_cell[i] + 1; }); });
  const std::vector<PatchEdge> edges = FindEdges(grid, cells, patches, config.sensor);
  SteadyNormals(edges, patches);
  const PatchScene scene{grid, cells, patches, edges, *table.table_C, config.sensor};
  const Grouping grouping = GroupPatches(scene);
  const PatchGroups& groups = grouping.groups;
  const std::vector<Vessel>& vessels = grouping.vessels;
  finished("grouping", [&] {
    return OfCells(grid, [&](size_t i) {
      const int patch = patches.patch_of_cell[i];
      return patch < 0 ? 0 : groups.Of(patch) + 1;
    });
  });
  const std::vector<int> objects = SelectObjects(scene, groups, table.outline, config);
  std::vector<uint16_t> label_of_group(groups.Count(), 0);
  for (size_t k = 0; k < objects.size(); ++k) {
    label_of_group[objects[k]] = static_cast<uint16_t>(k + 1);
  }
  std::vector<uint16_t> label_of_cell = LabelCells(patches, groups, label_of_group);
  LabelBottoms(scene, groups, vessels, label_of_group, label_of_cell);
  LabelPixels(image, grid, cells, std::move(label_of_cell), config.sensor, result.labels);
  NumberBySize(static_cast<int>(objects.size()), config.max_objects, result);
  cell_px = 1;
  finished("labels",
           [&] { return std::vector<uint32_t>(result.labels.begin(), result.labels.end()); });
  return result;
}

}  // namespace beckon::perception
