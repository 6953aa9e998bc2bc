// Which patches are neighbours, and whether they touch or one lies before the other.
#pragma once

#include <vector>

#include "services/perception/surface_patches.h"

namespace beckon::perception {

/// Neighbouring patches a < b. Counts are pairs of cells along their common border.
struct PatchEdge {
  int a = 0, b = 0;
  int n_touching = 0;  // the surfaces meet, as far as the sensor can tell
  int n_a_before = 0;  // a hides what b lies behind
  int n_b_before = 0;
};

/// Edges ordered by (a, b). Surfaces touch across one cell without depth at most; one lies before
/// the other also across the shadow that a projector leaves beside it.
std::vector<PatchEdge> FindEdges(const DepthGrid& grid, const SurfaceCells& cells,
                                 const SurfacePatches& patches, const SensorNoise& sensor);

/// Averages the patches' normals over the patches they touch that hardly turn from them, into
/// steady_normal_C: less noise on faces, and creases stay.
void SteadyNormals(const std::vector<PatchEdge>& edges, SurfacePatches& patches);

}  // namespace beckon::perception
