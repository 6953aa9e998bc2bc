// The offline mode: clouds from files, poses to files.
#include "services/pose/offline.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "services/base/cloud_file.h"
#include "services/base/utime.h"
#include "services/pose/labelled_scene.h"
#include "services/pose/picture.h"
#include "services/pose/pose_files.h"

namespace beckon::pose {
namespace {

Result<std::vector<CloudRequest>> Requests(const OfflineOptions& options) {
  if (options.inputs.empty() == options.list.empty()) {
    return Error{"expected either --input CLOUD.. or --list LIST.jsonl"};
  }
  if (!options.list.empty()) {
    if (!options.labels.empty()) return Error{"--labels goes with one --input"};
    if (!options.plane.empty())
      return Error{"--plane goes with --input; a list names its planes itself"};
    return ReadCloudList(options.list);
  }
  if (!options.labels.empty() && options.inputs.size() != 1) {
    return Error{"--labels goes with one --input, found " + std::to_string(options.inputs.size())};
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

// A cloud, or one object of it, with what is known of its rim.
struct Subject {
  CloudRequest request;
  std::vector<Eigen::Vector3f> points_F;
  std::vector<RimPoint> rim_F;
};

Result<std::vector<Subject>> ReadSubjects(const CloudRequest& request, const std::string& labels) {
  auto cloud = ReadCloudFile(request.path);
  if (!cloud) return Error{request.where + cloud.error().message};
  std::vector<Subject> subjects;
  if (labels.empty()) {
    subjects.push_back({request, std::move(cloud->points), {}});
    return subjects;
  }
  auto scene = ReadLabelledScene(*cloud, labels, request.table_F);
  if (!scene) return Error{request.path + " with --labels: " + scene.error().message};
  for (LabelledObject& object : scene->objects) {
    Subject& subject = subjects.emplace_back(
        Subject{request, std::move(object.points_C), std::move(object.rim_C)});
    subject.request.label = object.label;
    subject.request.table_F = scene->table_C;
  }
  return subjects;
}

// Estimates `repeat` times; the result of each is the same, the time is the median.
CloudPose EstimateRepeatedly(const Subject& subject, int repeat, const PoseConfig& config) {
  CloudPose pose;
  pose.request = subject.request;
  std::vector<double> times_ms;
  for (int i = 0; i < std::max(repeat, 1); ++i) {
    const Stopwatch stopwatch;
    pose.estimate = EstimateObject(
        {subject.points_F, subject.request.table_F, subject.request.viewpoint_F, subject.rim_F},
        config);
    times_ms.push_back(stopwatch.Milliseconds());
  }
  std::nth_element(times_ms.begin(), times_ms.begin() + static_cast<long>(times_ms.size() / 2),
                   times_ms.end());
  pose.time_ms = times_ms[times_ms.size() / 2];
  return pose;
}

std::string Title(const CloudRequest& request) {
  const std::string name = std::filesystem::path(request.file).filename().string();
  return request.label == 0 ? name : name + " " + std::to_string(request.label);
}

}  // namespace

Status RunOffline(const OfflineOptions& options, const PoseConfig& config) {
  const auto requests = Requests(options);
  if (!requests) return requests.error();
  std::vector<CloudPose> poses;
  std::vector<Portrait> portraits;
  for (const CloudRequest& request : *requests) {
    auto subjects = ReadSubjects(request, options.labels);
    if (!subjects) return subjects.error();
    for (Subject& subject : *subjects) {
      poses.push_back(EstimateRepeatedly(subject, options.repeat, config));
      if (options.picture.empty()) continue;
      const FitResult& fit = poses.back().estimate.fit;
      portraits.push_back(
          {Title(subject.request), std::move(subject.points_F), fit.shape, fit.converged});
    }
  }
  if (Status written = WriteTextFile(options.json, PosesToJson(poses, Name(config.fit.method)));
      !written) {
    return written;
  }
  return options.picture.empty() ? Status{} : DrawPortraits(options.picture, portraits);
}

}  // namespace beckon::pose
