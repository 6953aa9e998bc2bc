// Pictures of fits: points and wireframes as the camera saw them.
#pragma once

#include <string>
#include <vector>

#include "services/base/rgbd.h"
#include "services/pose/superquadric.h"

namespace beckon::pose {

/// What one tile shows.
struct Portrait {
  std::string title;
  std::vector<Eigen::Vector3f> points_C;
  Superquadric shape_C;
  bool converged = false;
};

/// Writes a PNG of 320x240 tiles, at most 64 and four a row, each zoomed to its object: points
/// grey, wireframe green where the fit converged, orange where not. From the camera at the origin.
Status DrawPortraits(const std::string& path, const std::vector<Portrait>& portraits);

}  // namespace beckon::pose
