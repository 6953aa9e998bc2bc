// The groups of measurements that the shape cue consists of. Each appends a fixed number of values.
#pragma once

#include <vector>

#include "services/perception/cue_view.h"

namespace beckon::perception {

/// The quantile of `values`, 0 where there are none.
float Quantile(std::vector<float> values, float quantile);

/// The body of revolution that fits best: its vertical axis and its radius over the height.
struct Revolution {
  static constexpr int kBins = 8;

  Eigen::Vector2f axis_T = Eigen::Vector2f::Zero();  // m, x and y of frame T
  float height_m = 0;                                // 98 % of the points lie below
  float axis_residual_m = 0;    // how far the normals' lines miss the axis, RMS
  std::vector<float> radii_m;   // of each point
  float profile_m[kBins] = {};  // median radius in each bin of height, interpolated where empty
  float spread_m[kBins] = {};   // interquartile range of the radii
  float share[kBins] = {};      // of the points
  float max_radius_m = 0;

  int Bin(float z) const;
};

Revolution FitRevolution(const CueView& view);

/// Metric extents and their ratios.
void MeasureSizes(const CueView& view, std::vector<float>& out);
/// Radius and width over height, roundness of slices, what sticks out of the body of revolution.
void MeasureProfile(const CueView& view, const Revolution& body, std::vector<float>& out);
/// Where the surface faces.
void MeasureNormals(const CueView& view, const Revolution& body, std::vector<float>& out);
/// Hollow or solid, convex or concave.
void MeasureHollowness(const CueView& view, const Revolution& body, std::vector<float>& out);
/// The outline in the image.
void MeasureOutline(const CueView& view, std::vector<float>& out);

}  // namespace beckon::perception
