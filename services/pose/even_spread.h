// A few points that stand for many: evenly spread over the surface, each with what it is worth.
#pragma once

#include <span>
#include <vector>

#include "services/pose/fit_stage.h"

namespace beckon::pose {

struct SpreadPoints {
  PointList points;
  std::vector<double> weights;  // 0 .. 1, of each
};

/// About `count` centroids of the voxels of a grid that is chosen for it, in the order of the
/// voxels' first points. A voxel with less than half as many points as is usual (their median)
/// weighs less in proportion: the pixels that fly between an edge and what is behind it are spread
/// thin. All points, of weight 1, where there are no more than `count`.
SpreadPoints SpreadEvenly(std::span<const Eigen::Vector3d> points, int count);

}  // namespace beckon::pose
