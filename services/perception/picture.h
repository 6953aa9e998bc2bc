// Draws what was perceived into the camera's image, for people.
#pragma once

#include <string>

#include "services/perception/perceiver.h"

namespace beckon::perception {

/// Writes the colour image (the depth in grey where there is none) with the table's outline and
/// every object's outline and name, and the time of each step, to an image file (.png, .jpg).
Status WritePicture(const std::string& path, const RgbdImage& image, const Perception& perception);

/// Writes a picture of what a step of segmentation made of the image, every region in a colour of
/// its own. Fails for a step that the configured method does not come to, and names those it does.
Status WriteStagePicture(const std::string& path, const RgbdImage& image,
                         const SegmentationConfig& config, const Perception& perception,
                         const std::string& stage);

/// Writes a 16-bit PNG of the image's size: 0 background, k = the object with id k.
Status WriteLabels(const std::string& path, const RgbdImage& image, const Perception& perception);

}  // namespace beckon::perception
