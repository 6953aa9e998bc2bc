// Offline: a folder of single objects, rendered, to train a categoriser with.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "services/base/result.h"

namespace beckon::capture {

struct ObjectSetPlan {
  uint64_t seed = 1;
  int per_category = 90;   // fresh objects of each category, and twice as many of none
  int views = 2;           // of each object
  bool any_camera = true;  // false: a Kinect only
  std::string meshes;      // a folder of meshes to render as well (see mesh_files.h); empty = none
};

/// Writes `<Category>/<instance>_viewM.pcd` (the object's points in C, with colour) with its
/// `_rgb.png`,
/// `_depth.png` (mm) and `_mask.png` crops, and `manifest.csv`. Objects of no category are in
/// `Unknown`. The same plan gives the same files, on any number of cores. `progress` is told now
/// and then how many objects of how many are done, from any thread, one at a time.
Status WriteObjectSet(const std::string& folder, const ObjectSetPlan& plan,
                      const std::function<void(size_t, size_t)>& progress = {});

}  // namespace beckon::capture
