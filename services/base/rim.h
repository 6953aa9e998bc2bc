// The rim of an object in an image, and what lies beyond it: where an outline is the object's own,
// and where something else cuts it off.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "services/base/rgbd.h"

namespace beckon {

/// What the image shows just outside a point of the rim.
enum class Beyond : int8_t {
  kUnknown = 0,      // no depth, or nobody looked
  kFarther = 1,      // the background: the outline is the object's own
  kNearer = 2,       // an occluder: the object goes on behind it
  kLevel = 3,        // what touches it, such as the table at its foot or a neighbour
  kImageBorder = 4,  // the end of the image: the object goes on outside
};

/// A visible point of the object beside which another surface, or none, begins.
struct RimPoint {
  Eigen::Vector3f point;  // m, in the frame of the object's points
  Beyond beyond = Beyond::kUnknown;

  bool operator==(const RimPoint&) const = default;
};

/// Most points of a rim that are ever asked for.
inline constexpr int kMaxRim = 96;

/// How much deeper or nearer a surface at depth `z_m` must be to count as another one, m:
/// max(8 mm, 3 sigma), sigma = 1.2 mm + 1.9 mm (z - 0.4)^2, z in m, being the noise of a Kinect
/// (Nguyen, Izadi & Lovell 2012).
float ClearStep(float z_m);

/// The rims of objects 1 .. `n_objects` of a label image (row-major, of the image's size; 0 = no
/// object), in this order; all empty where sizes differ. Only outer contours count, of every piece
/// of an object that has a twentieth of its pixels: a hole, or a gap with the object on its other
/// side, has no rim. Each rim has at most `most` points in C, evenly spread along the contour,
/// clockwise as seen, each on the ray of an outermost pixel (the outline itself runs half a pixel
/// outside) with the median depth of the object around it.
///
/// What lies beyond is looked for outward along the contour's normal, across up to 20 px without
/// depth (sensors that project light leave such shadows beside edges), and decided by the median of
/// the neighbouring rays. `table_C`, where known, is compared at the rim's own ray, so that at the
/// foot of an object the table is level however far out it is first seen. The end of the image is
/// where its depth ends, up to 16 px inside it. Deterministic; the time of one pass over the
/// labels.
std::vector<std::vector<RimPoint>> FindRims(const RgbdImage& image,
                                            std::span<const uint16_t> labels, int n_objects,
                                            const std::optional<Plane>& table_C,
                                            int most = kMaxRim);

}  // namespace beckon
