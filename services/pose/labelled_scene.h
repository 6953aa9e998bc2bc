// The objects of an organised scene that an image labels.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/base/geometry.h"
#include "services/base/result.h"
#include "services/base/rgbd.h"
#include "services/base/rim.h"

namespace beckon::pose {

struct LabelledObject {
  uint16_t label = 0;
  std::vector<Eigen::Vector3f> points_C;
  std::vector<RimPoint> rim_C;
};

struct LabelledScene {
  RgbdImage image;
  Plane table_C;  // normal to the camera where it was found, as given otherwise
  std::vector<LabelledObject> objects;  // by label
};

/// The objects of `cloud`, which is organised, as the 16-bit grey PNG `path` of its size labels
/// them (0 = no object), seen as the service sees those of a SCENE. The table is found where it is
/// not given. Errors name the file.
Result<LabelledScene> ReadLabelledScene(const Cloud& cloud, const std::string& path,
                                        const std::optional<Plane>& table_C);

}  // namespace beckon::pose
