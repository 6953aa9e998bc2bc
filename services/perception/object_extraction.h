// What there is to know of each segmented object but its category: its pixels, where it is, how
// large, and a thinned cloud of it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "services/perception/segmentation.h"

namespace beckon::perception {

struct ExtractedObject {
  std::vector<uint32_t> pixels;      // row-major indices into the image, ascending; all have depth
  std::vector<uint32_t> silhouette;  // the same and those known to be the object's that have none
  Eigen::Vector3d centroid_C = Eigen::Vector3d::Zero();  // of the visible points
  Eigen::Vector3d centroid_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d extent_W = Eigen::Vector3d::Zero();  // of their axis-aligned box in W
  std::vector<std::array<int16_t, 2>> outline_px;  // of the silhouette, closed, clockwise as seen;
                                                   // u and v; by OutlineMemory
};

/// Objects 1 .. n_objects of `segmentation`, in this order, but for their outlines; empty where it
/// has no table. `silhouettes` are like the labels, with more pixels.
std::vector<ExtractedObject> ExtractObjects(const RgbdImage& image,
                                            const Segmentation& segmentation, const Pose& X_WC,
                                            std::span<const uint16_t> silhouettes);

/// At most `most` points of C spread evenly over the visible surface: the means of voxels as fine
/// as that allows, though never finer than 2 mm. Deterministic.
std::vector<Eigen::Vector3f> SampleSurface(const RgbdImage& image, std::span<const uint32_t> pixels,
                                           int most);

}  // namespace beckon::perception
