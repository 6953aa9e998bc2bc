// Depth images as they should not be, and what any segmentation of them must be.
#pragma once

#include <string>

#include "services/perception/segmentation.h"
#include "tests/draws.h"

namespace beckon::perception {

/// A view of a table, or less than that, which any damages befell: depth that is no number or out
/// of range, holes, stripes, shifted rows, noise, one depth for all, a part of the image only, a
/// camera that none is. At most `width` wide.
RgbdImage HostileImage(Draws& draws, int width);

/// Settings that the configuration allows, mostly the defaults.
SegmentationConfig AnyConfig(Draws& draws);

/// What is wrong with a segmentation, whatever it is of; empty where nothing is.
std::string Unsound(const RgbdImage& image, const SegmentationConfig& config,
                    const Segmentation& result);

/// Whether two segmentations are the same to the bit.
bool Same(const Segmentation& a, const Segmentation& b);

}  // namespace beckon::perception
