// The rim of an object in an image, and what lies beyond it: where an outline is the object's own, and
// where something else cuts it off.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "services/base/rgbd.h"

namespace beckon {

/// What the image shows just outside a point of the rim.
enum class Beyond : int8_t {
  kUnknown = 0,      // no depth, or nobody looked
  kFarther = 1,      // the background: the outline is the object's own
  kNearer = 2,       // an occluder: the object goes on behind it
  kLevel = 3,        // what touches it, such as the table at its foot or a neighbour
  kImageBorder = 4,  // the end of the image: the object goes on outside
};

/// A visible point of the object beside which another surface, or none, begins.
struct RimPoint {
  Eigen::Vector3f point;  // m, in the frame of the object's points
  Beyond beyond = Beyond::kUnknown;
};

}  // namespace beckon
