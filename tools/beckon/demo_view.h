// The left part of a demo's picture: the camera's image with what was recognised in it.
#pragma once

#include <map>
#include <opencv2/core/mat.hpp>

#include "services/base/rgbd.h"
#include "tools/beckon/demo_story.h"

namespace beckon::tool {

/// Objects' numbers by id, counted from left to right as the console does.
std::map<int, int> NumbersFromLeft(const msg::Scene& scene);

/// `image`, `width_px` wide, with outlines, names, superquadrics and the first task's grasp.
/// `story` has a scene.
cv::Mat DrawView(const RgbdImage& image, const DemoStory& story, int width_px);

}  // namespace beckon::tool
