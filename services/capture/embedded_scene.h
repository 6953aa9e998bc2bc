// The embedded scene: a table-top that knows its ground truth. The same seed gives the same bytes.
#pragma once

#include <string>
#include <vector>

#include "services/base/rgbd.h"
#include "services/capture/scene_description.h"

namespace beckon::capture {

/// An image and all that is known of it.
struct EmbeddedFrame {
  RgbdImage image;               // 640x480, depth in whole millimetres
  std::vector<uint16_t> labels;  // a pixel; 0 = no object or no depth, k = object k
  SceneDescription description;
};

/// 4 to 8 objects of random categories.
EmbeddedFrame RenderEmbeddedScene(uint64_t seed);

/// The seed of frame `index` (from 0) of a series.
uint64_t FrameSeed(uint64_t seed, uint64_t index);

}  // namespace beckon::capture
