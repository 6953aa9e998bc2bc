// The flat faces of groups of patches.
#pragma once

#include <vector>

#include "services/perception/object_grouping.h"

namespace beckon::perception {

/// Patches of one group on one plane, w = slope · ray.
struct Face {
  int group = 0;
  std::vector<int> patches;
  Eigen::Vector3f slope{0, 0, 0};
  Eigen::Vector3f normal_C{0, 0, -1};
  Eigen::Vector3f centre_C{0, 0, 0};
  float area_m2 = 0;
  float off = 0;  // root mean square of the patches' distances, in standard deviations of a reading

  float InverseDepth(const Eigen::Vector3f& ray) const { return slope.dot(ray); }
};

/// Connected patches of each group whose normals differ by less than about ten degrees from one to
/// the next and from the face's; those that do not fit a plane are no face.
std::vector<Face> FindFaces(const PatchScene& scene, const PatchGroups& groups);

/// The least-squares plane through the patches of faces.
Face FitFace(const PatchScene& scene, int group, std::vector<int> patches);

}  // namespace beckon::perception
