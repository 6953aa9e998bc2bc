// Images and clouds as every service holds them: plain memory, no library's types.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "services/base/geometry.h"
#include "services/base/result.h"

namespace beckon {

using Rgb = std::array<uint8_t, 3>;  // red, green, blue

/// A registered depth and colour image, row-major.
struct RgbdImage {
  int width = 0;
  int height = 0;
  Intrinsics intrinsics;
  std::vector<float> depth_m;  // width * height, along z; 0 = no depth; never NaN
  std::vector<Rgb> colour;     // width * height, or empty where there is none

  bool HasDepth(int u, int v) const { return depth_m[Index(u, v)] > 0; }
  size_t Index(int u, int v) const { return static_cast<size_t>(v) * width + u; }
  /// The surface point in C at a pixel that has depth.
  Eigen::Vector3d Point(int u, int v) const {
    return intrinsics.Unproject(u, v, depth_m[Index(u, v)]);
  }
};

/// Points in C, in metres. Organised (height > 1): row-major, NaN where there is no depth.
struct Cloud {
  int width = 0;
  int height = 1;
  std::vector<Eigen::Vector3f> points;
  std::vector<Rgb> colours;      // one a point, or empty
  std::vector<uint32_t> labels;  // one a point, or empty (ground truth of some data sets)

  bool organised() const { return height > 1; }
};

/// The pinhole camera an organised cloud was taken with, by least squares of x/z over u and y/z
/// over v. Fails where fewer than 100 points have depth or the points do not lie on pixel rays.
Result<Intrinsics> EstimateIntrinsics(const Cloud& organised);

/// An image from a cloud: an organised one keeps its grid (with `intrinsics`, else estimated ones);
/// an unorganised one is projected onto 640x480 with `intrinsics`, or f 525 px, c (319.5, 239.5),
/// the nearest point winning a pixel. `labels`, where not null, receives the cloud's labels on the
/// grid. Fails where no point has a finite position in front of the camera.
Result<RgbdImage> ToImage(const Cloud& cloud, const Intrinsics* intrinsics = nullptr,
                          std::vector<uint32_t>* labels = nullptr);

}  // namespace beckon
