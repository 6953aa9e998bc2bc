// Draws what was perceived into the camera's image, for people.
#pragma once

#include <string>

#include "services/perception/perceiver.h"

namespace beckon::perception {

/// Writes the colour image (the depth in grey where there is none) with the table's outline and
/// every object's outline and name to an image file (.png, .jpg).
Status WritePicture(const std::string& path, const RgbdImage& image, const Perception& perception);

/// Writes a 16-bit PNG of the image's size: 0 background, k = the object with id k.
Status WriteLabels(const std::string& path, const RgbdImage& image, const Perception& perception);

}  // namespace beckon::perception
