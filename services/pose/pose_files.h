// The files of the offline mode: lists of clouds in, poses as JSON out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/base/geometry.h"
#include "services/base/result.h"
#include "services/pose/estimate.h"

namespace beckon::pose {

/// A cloud to fit.
struct CloudRequest {
  std::string file;   // as the user gave it
  std::string path;   // where it is
  std::string where;  // what names it in messages, e.g. "list.jsonl:3: cup.xyz"
  int label = 0;      // of the object in a labelled scene; 0 = the whole cloud
  std::optional<Plane> table_F;
  Eigen::Vector3d viewpoint_F = Eigen::Vector3d::Zero();
};

/// A line per cloud, {"file": .., "plane": [nx, ny, nz, d], "viewpoint": [x, y, z]}; the file
/// relative to the list, plane and viewpoint optional, other keys ignored. Errors name list and
/// line.
Result<std::vector<CloudRequest>> ReadCloudList(const std::string& path);

/// A plane from "nx,ny,nz,d"; its normal of any length but 0.
Result<Plane> ParsePlane(const std::string& text);

/// A cloud with its estimate.
struct CloudPose {
  CloudRequest request;
  Estimate estimate;
};

/// The JSON of docs/formats.md: a list in input order, all in the input's frame.
std::string PosesToJson(const std::vector<CloudPose>& poses, const std::string& method);

/// Writes the whole file or says why not.
Status WriteTextFile(const std::string& path, const std::string& text);

}  // namespace beckon::pose
