// Offline: frames of the embedded scene with their ground truth.
#pragma once

#include <cstdint>
#include <string>

#include "services/base/result.h"

namespace beckon::capture {

/// Writes NNNN.pcd (organised, x y z rgba label), NNNN_rgb.png, NNNN_depth.png (mm),
/// NNNN_labels.png (16 bit) and NNNN_truth.json for `frames` frames whose seeds derive from `seed`.
Status WriteFrameSet(const std::string& folder, uint64_t seed, int frames);

}  // namespace beckon::capture
