// What all cues look at: an object view made ready once. Cloud, normals and neighbours in a frame
// that stands on the table, and the outline's box in the image.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "services/perception/object_view.h"

namespace beckon::perception {

/// Frame T: z up (the table's normal; where it is not known what EstimateUp finds, else that of a
/// camera pitched 38 degrees down), y away from the camera along the table, x right; its origin is
/// the middle of the visible points, at the height of the lowest of them.
struct CueView {
  static constexpr int kMaxPoints = 1000;
  static constexpr float kVoxel_m = 0.005F;  // larger where more than kMaxPoints would remain
  static constexpr float kNeighbourRadius_m = 0.03F;
  static constexpr float kNormalRadius_m = 0.02F;

  const ObjectView& object;
  int box_u = 0, box_v = 0, box_width = 0, box_height = 0;  // px, of the mask in the image
  std::vector<uint8_t> mask;  // box_width * box_height, 255 on the object

  Eigen::Matrix3f R_TC = Eigen::Matrix3f::Identity();
  Eigen::Vector3f origin_C = Eigen::Vector3f::Zero();
  Eigen::Matrix3Xf points_T;   // m, centroids of the voxels
  Eigen::Matrix3Xf normals_T;  // unit, towards the camera
  float voxel_m = kVoxel_m;

  // Neighbours of point i within kNeighbourRadius_m: indices neighbours[first[i] .. first[i + 1]).
  std::vector<uint32_t> first;
  std::vector<uint32_t> neighbours;
  std::vector<float> squared_distances_m2;  // of each neighbour

  int size() const { return static_cast<int>(points_T.cols()); }
};

/// The view's pixels that lie inside the image and have depth; pixels outside the image are
/// ignored.
int CountPoints(const ObjectView& view);

/// `view` needs at least one point.
CueView MakeCueView(const ObjectView& view);

}  // namespace beckon::perception
