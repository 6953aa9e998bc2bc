// The default segmentation: on a coarser grid of inverse depths, patches of surface are grouped by
// how they meet.
#pragma once

#include "services/perception/segmentation.h"

namespace beckon::perception {

/// Deterministic. Steps told to `done`: grid, table, surface, patches, grouping, labels.
Segmentation SegmentFast(const RgbdImage& image, const SegmentationConfig& config,
                         const StepObserver& done = {});

}  // namespace beckon::perception
