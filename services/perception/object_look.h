// What an object looks like in an image: where it is, how large, of which colours.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "services/base/rgbd.h"

namespace beckon::perception {

struct ObjectLook {
  int n_pixels = 0;
  Eigen::Vector3d centroid_C = Eigen::Vector3d::Zero();  // of the visible points
  double area_m2 = 0;                                    // visible, as it faces the camera
  /// Shares of 4 x 4 x 4 cells of red, green and blue, sum 1; all zero for an image without colour.
  std::array<float, 64> colours{};
};

/// The looks of objects 1 .. n_labels; labels beyond are not looked at. Every second row and column
/// is enough, but for n_pixels. Pixels without depth count for n_pixels alone.
std::vector<ObjectLook> LookAt(const RgbdImage& image, std::span<const uint16_t> labels,
                               int n_labels);

/// How alike the colours are, 0 .. 1: what the histograms share (Swain & Ballard, "Color Indexing",
/// 1991). 1 where either has no colour.
double Likeness(const ObjectLook& a, const ObjectLook& b);

}  // namespace beckon::perception
