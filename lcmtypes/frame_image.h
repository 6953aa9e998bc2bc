// Between an RgbdImage and the compressed images of a Frame.
#pragma once

#include "lcmtypes/messages.h"

namespace beckon {

/// Compresses `image` into `frame` (codecs, sizes, intrinsics; not time, seq and source). Depth is
/// rounded to `depth_unit_m` and is then lossless; beyond 65,535 units it is dropped. Colour is
/// JPEG of `jpeg_quality`.
Status EncodeImage(const RgbdImage& image, double depth_unit_m, int jpeg_quality,
                   msg::Frame& frame);

/// The image of a frame; fails where the compressed images are damaged or of another size than
/// told.
Result<RgbdImage> DecodeImage(const msg::Frame& frame);

}  // namespace beckon
