// A picture of a whole scene: the camera's image with every object's fit over it.
#pragma once

#include <span>
#include <string>

#include "services/base/rgbd.h"
#include "services/pose/estimate.h"

namespace beckon::pose {

/// An object of the scene, its estimate in the camera's frame C.
struct SceneObjectFit {
  std::string title;
  Estimate estimate;
};

/// Writes the image (without colour: its depth in grey), enlarged to at least 1280 px wide where it
/// is smaller, with each object's wireframe in a colour of its own, axes, best grasp and a label
/// with its size. Hidden lines and fits that did not converge (dashed) are fainter; labels keep off
/// each other and off objects where there is room. An organised cloud becomes an image by ToImage.
Status DrawScene(const std::string& path, const RgbdImage& image,
                 std::span<const SceneObjectFit> objects, const GripperConfig& gripper);

}  // namespace beckon::pose
