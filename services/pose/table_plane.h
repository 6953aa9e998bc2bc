// The table under labelled objects, where nobody says which plane it is.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>

#include "services/base/geometry.h"
#include "services/base/rgbd.h"

namespace beckon::pose {

/// The plane that most of the unlabelled points close to labelled ones lie on, in C, its normal to
/// the camera: RANSAC (Fischler & Bolles 1981) with a fixed seed, refined by least squares. Planes
/// that cut through the objects are not considered, and none is found where fewer than 200 points,
/// or less than a quarter of those looked at, lie on one. `labels`: row-major, of the image's size,
/// 0 = no object. Deterministic; fails with what to do.
Result<Plane> FindTablePlane(const RgbdImage& image, std::span<const uint16_t> labels);

}  // namespace beckon::pose
