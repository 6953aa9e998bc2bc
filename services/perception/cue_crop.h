// The object's own pixels as square OpenCV images of a size of their own.
#pragma once

#include <opencv2/core.hpp>

#include "services/perception/cue_view.h"

namespace beckon::perception {

/// The outline, small holes closed, 255 on the object, scaled so that the box's longer side plus a
/// margin of 1/16 on each side fills `size` px.
cv::Mat CropMask(const CueView& view, int size);

/// Brightness in the same place; the object's mean off the object. Grey 128 throughout without
/// colour.
cv::Mat CropGrey(const CueView& view, int size);

/// Depth in the same place, `half_range_m` around the object's median mapped to 0..255; off the
/// object and where there is no depth the farthest.
cv::Mat CropDepth(const CueView& view, int size, float half_range_m);

}  // namespace beckon::perception
