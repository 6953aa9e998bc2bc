// Views of single embedded objects, cut out of their scene, to train a categoriser with.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/base/rgbd.h"
#include "services/capture/embedded_model.h"
#include "services/capture/embedded_raycaster.h"

namespace beckon::capture {

/// A cut-out around one object. `crop` is in a 640x480 image of `intrinsics`.
struct ObjectView {
  Intrinsics intrinsics;
  Window crop;
  std::vector<float> depth_m;  // of all that is in the crop
  std::vector<Rgb> colour;
  std::vector<uint8_t> mask;            // 255 = the object, as a segmentation would outline it
  std::optional<Eigen::Vector3d> up_C;  // the table's normal, as far as it was found
  double visible_share = 1;             // of its pixels, the rest being hidden by a neighbour
};

/// A random view of a model on a table, by a Kinect or by any depth camera that a lab may have; in
/// about 30 % a neighbour hides part of it. None where
/// it never fits into view, or next to nothing of it is ever seen.
std::optional<ObjectView> RenderObjectView(const Model& model, bool any_camera, Random& random);

}  // namespace beckon::capture
