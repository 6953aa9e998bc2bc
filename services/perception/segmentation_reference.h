// The dissertation's segmentation (chapter 3): range filter, voxel grid, normals, RANSAC table
// plane, convex hull, prism above it, Euclidean clusters; then the labels of voxels for every
// pixel.
#pragma once

#include "services/perception/segmentation.h"

namespace beckon::perception {

/// Deterministic: RANSAC draws from a fixed seed. Steps told to `done`: range_voxels, normals
/// (where used), plane, hull, prism, clusters, labels.
Segmentation SegmentReference(const RgbdImage& image, const SegmentationConfig& config,
                              const StepObserver& done = {});

}  // namespace beckon::perception
