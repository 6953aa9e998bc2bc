// Ground truth of a scene, as it is known of rendered and of labelled images.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "services/base/rgbd.h"

namespace beckon::capture {

struct DescribedObject {
  int label = 0;
  std::string category;
  Eigen::Vector3d centroid_C = Eigen::Vector3d::Zero();  // m, of the visible points
  Eigen::AlignedBox3d box_C;                             // m, of the visible points
  int visible_points = 0;
  std::optional<Pose> X_CO;  // z = the object's axis, origin = centre of its bounding box
  std::optional<Pose> X_WO;
};

struct SceneDescription {
  bool known = false;  // false: nothing is known of what the image shows
  std::optional<Plane> table_C;
  Intrinsics intrinsics;
  std::vector<DescribedObject> objects;  // by ascending label
};

/// Centroid, box and number of the points of each label in `categories` (labels without a point are
/// left out). `labels` has an entry a pixel.
std::vector<DescribedObject> DescribeLabels(const RgbdImage& image,
                                            const std::vector<uint32_t>& labels,
                                            const std::map<int, std::string>& categories);

}  // namespace beckon::capture
