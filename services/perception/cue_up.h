// Which way is up around an object, where nobody has found the table yet.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "services/perception/object_view.h"

namespace beckon::perception {

/// The unit normal, in C and towards the camera, of the plane that most of what is seen around the
/// object lies on and the object stands above; none where too little of one is seen. Same view,
/// same answer.
std::optional<Eigen::Vector3f> EstimateUp(const ObjectView& view);

}  // namespace beckon::perception
