// One object as one image shows it: what the categoriser is given.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "services/base/rgbd.h"

namespace beckon::perception {

/// Borrowed for the duration of a call. The image may be the whole frame or a crop of it whose
/// intrinsics were shifted along; only the object's own pixels are read.
struct ObjectView {
  const RgbdImage& image;
  std::span<const uint32_t> pixels;  // row-major indices into `image` of the object's mask, any
                                     // order; pixels without depth count for the contour alone
  std::optional<Plane> table_C =
      {};  // the table, normal towards the camera; only its normal is used.
           // Without it a camera pitched 38 degrees down is assumed
};

}  // namespace beckon::perception
