// Which groups of patches are objects on the table.
#pragma once

#include <span>
#include <vector>

#include "services/perception/object_grouping.h"
#include "services/perception/segmentation.h"

namespace beckon::perception {

/// The part of the grid that shows the space over the table, up to max_height_m.
CellRectangle SpaceOverTable(const DepthGrid& grid, const Plane& table_C,
                             std::span<const Eigen::Vector3d> hull_C, double max_height_m);

/// Marks the cells of `inverse_depth` within `part` that are above the table by more than the least
/// height and the noise, up to max_height_m; narrows `cells.part` down to them.
void MarkAboveTable(const DepthGrid& grid, const std::vector<float>& inverse_depth,
                    const CellRectangle& part, const Plane& table_C,
                    const SegmentationConfig& config, SurfaceCells& cells);

/// Groups of which the camera sees at least min_object_m2 that reach min_height_m above the table
/// and have a fifth of their cells deeper within the table's outline than border_m: a wall behind
/// the table, a chair before it or a tray beside it has not.
std::vector<int> SelectObjects(const PatchScene& scene, const PatchGroups& groups,
                               std::span<const Eigen::Vector2d> outline,
                               const SegmentationConfig& config);

}  // namespace beckon::perception
