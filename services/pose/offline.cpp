// The offline mode: clouds from files, poses to files.
#include "services/pose/offline.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "services/base/cloud_file.h"
#include "services/base/utime.h"
#include "services/pose/mesh.h"
#include "services/pose/picture.h"
#include "services/pose/pose_files.h"

namespace beckon::pose {
namespace {

Result<std::vector<CloudRequest>> Requests(const OfflineOptions& options) {
  if (options.inputs.empty() == options.list.empty()) {
    return Error{"expected either --input CLOUD.. or --list LIST.jsonl"};
  }
  if (!options.list.empty()) {
    if (!options.plane.empty())
      return Error{"--plane goes with --input; a list names its planes itself"};
    return ReadCloudList(options.list);
  }
  std::vector<CloudRequest> requests;
  for (const std::string& file : options.inputs) {
    CloudRequest& request = requests.emplace_back();
    request.file = request.path = file;
    if (options.plane.empty()) continue;
    const Result<Plane> plane = ParsePlane(options.plane);
    if (!plane) return plane.error();
    request.table_F = *plane;
  }
  return requests;
}

// Estimates `repeat` times; the result of each is the same, the time is the median.
CloudPose EstimateRepeatedly(CloudRequest request, const Cloud& cloud, int repeat,
                             const PoseConfig& config) {
  CloudPose pose;
  pose.request = std::move(request);
  std::vector<double> times_ms;
  for (int i = 0; i < std::max(repeat, 1); ++i) {
    const Stopwatch stopwatch;
    pose.estimate =
        EstimateObject({cloud.points, pose.request.table_F, pose.request.viewpoint_F}, config);
    times_ms.push_back(stopwatch.Milliseconds());
  }
  std::nth_element(times_ms.begin(), times_ms.begin() + static_cast<long>(times_ms.size() / 2),
                   times_ms.end());
  pose.time_ms = times_ms[times_ms.size() / 2];
  return pose;
}

// The surfaces of the fits that converged, as one PLY file.
Status WriteMesh(const std::string& path, const std::vector<CloudPose>& poses) {
  constexpr int kSegments = 64;
  TriangleMesh mesh;
  for (const CloudPose& pose : poses) {
    const FitResult& fit = pose.estimate.fit;
    if (fit.converged) Append(MakeMesh(fit.shape, kSegments), mesh);
  }
  return WriteTextFile(path, MeshToPly(mesh));
}

}  // namespace

Status RunOffline(const OfflineOptions& options, const PoseConfig& config) {
  const auto requests = Requests(options);
  if (!requests) return requests.error();
  std::vector<CloudPose> poses;
  std::vector<Portrait> portraits;
  for (const CloudRequest& request : *requests) {
    auto cloud = ReadCloudFile(request.path);
    if (!cloud) return Error{request.where + cloud.error().message};
    poses.push_back(EstimateRepeatedly(request, *cloud, options.repeat, config));
    if (options.picture.empty()) continue;
    const FitResult& fit = poses.back().estimate.fit;
    portraits.push_back({std::filesystem::path(request.file).filename().string(),
                         std::move(cloud->points), fit.shape, fit.converged});
  }
  if (Status written = WriteTextFile(options.json, PosesToJson(poses, Name(config.fit.method)));
      !written) {
    return written;
  }
  if (!options.mesh.empty()) {
    if (Status written = WriteMesh(options.mesh, poses); !written) return written;
  }
  return options.picture.empty() ? Status{} : DrawPortraits(options.picture, portraits);
}

}  // namespace beckon::pose
