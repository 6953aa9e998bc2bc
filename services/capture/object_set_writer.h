// Offline: a folder of single embedded objects to train a categoriser with.
#pragma once

#include <cstdint>
#include <string>

#include "services/base/result.h"

namespace beckon::capture {

/// Writes `<Category>/<instance>_viewM.pcd` (the object's points in C, with colour) with its
/// `_rgb.png`,
/// `_depth.png` (mm) and `_mask.png` crops for `per_category` fresh objects of each category, two
/// views of each, and `manifest.csv`. The same seed gives the same files.
Status WriteObjectSet(const std::string& folder, uint64_t seed, int per_category);

}  // namespace beckon::capture
