// Small, nearly flat patches of the surfaces above the table.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "services/perception/depth_grid.h"

namespace beckon::perception {

/// Cells that may belong to objects, with what is known of their surface.
struct SurfaceCells {
  CellRectangle part;                               // all such cells are in it
  std::vector<uint8_t> used;                        // a cell of the grid; 1 = above the table
  std::vector<float> inverse_depth;                 // smoothed
  std::vector<float> normal_x, normal_y, normal_z;  // in C, towards the camera; where used
};

/// A patch, its cells fitted by a plane w = slope · ray of the unsmoothed inverse depths.
struct Patch {
  int n_cells = 0;
  float u = 0, v = 0;  // centroid in the grid, cells
  Eigen::Vector3f slope{0, 0, 0};
  Eigen::Vector3f centre_C{0, 0, 0};          // on the plane, m
  Eigen::Vector3f normal_C{0, 0, -1};         // towards the camera
  float area_m2 = 0;                          // of the surface
  float seen_m2 = 0;                          // across the line of sight
  Eigen::Vector3f steady_normal_C{0, 0, -1};  // averaged over neighbours that hardly differ
  float normal_sigma = 0;                     // rad, of the normal by the sensor's noise

  float InverseDepth(const Eigen::Vector3f& ray) const { return slope.dot(ray); }
};

struct SurfacePatches {
  static constexpr int kNone = -1;
  std::vector<Patch> patches;
  std::vector<int> patch_of_cell;  // index into patches, or kNone
};

/// Fills in the normals of the used cells, from the slopes of inverse depth: the plane n·p = d is
/// w = n·ray / d. At an edge the flatter side decides.
void EstimateNormals(const DepthGrid& grid, const SensorNoise& sensor, SurfaceCells& cells);

/// Patches about `kPatchCells` wide by k-means over place, distance from the patch's plane in units
/// of the noise, and normal (after SLIC: Achanta et al., "SLIC Superpixels Compared to
/// State-of-the-Art Superpixel Methods", 2012). Each is connected.
SurfacePatches MakePatches(const DepthGrid& grid, const SurfaceCells& cells,
                           const SensorNoise& sensor);

inline constexpr int kPatchCells = 6;

}  // namespace beckon::perception
