// The depth image on a coarser grid of inverse depths, where all of fast segmentation happens.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "services/base/rgbd.h"
#include "services/perception/sensor_noise.h"

namespace beckon::perception {

/// Cells of `pixels` x `pixels` pixels, row-major; what remains at the right and lower border
/// belongs to no cell.
struct DepthGrid {
  int width = 0;
  int height = 0;
  int pixels = 1;                        // edge length of a cell
  float fx = 1, fy = 1, cx = 0, cy = 0;  // the camera, in cells
  std::vector<float> inverse_depth;      // of each cell, 1/m; 0 where it has none
  int n_pixels = 0;                      // of the image, in range

  size_t Size() const { return inverse_depth.size(); }
  size_t Index(int u, int v) const { return static_cast<size_t>(v) * width + u; }
  Eigen::Vector3f Ray(float u, float v) const { return {(u - cx) / fx, (v - cy) / fy, 1}; }
  /// The surface point in C at a position that has inverse depth w.
  Eigen::Vector3f Point(float u, float v, float w) const { return Ray(u, v) / w; }
};

/// A part of the grid: columns left .. right - 1, rows top .. bottom - 1.
struct CellRectangle {
  int left = 0, top = 0, right = 0, bottom = 0;
};

/// Pixels along a cell's edge: cells see about 1/262 rad, two pixels of a 640x480 Kinect.
int PixelsPerCell(const Intrinsics& intrinsics);

/// Keeps depth within [min_range_m, max_range_m]. A cell holds the mean of the pixels that lie on
/// the nearest of the surfaces in it, as far as the sensor can tell them apart.
DepthGrid MakeDepthGrid(const RgbdImage& image, double min_range_m, double max_range_m,
                        const SensorNoise& sensor);

}  // namespace beckon::perception
