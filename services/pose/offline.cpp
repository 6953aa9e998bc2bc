// The offline mode: clouds from files, poses to files.
#include "services/pose/offline.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "services/base/cloud_file.h"
#include "services/base/utime.h"
#include "services/pose/labelled_scene.h"
#include "services/pose/mesh.h"
#include "services/pose/picture.h"
#include "services/pose/picture_scene.h"
#include "services/pose/pose_files.h"

namespace beckon::pose {
namespace {

Result<std::vector<CloudRequest>> Requests(const OfflineOptions &options) {
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
  for (const std::string &file : options.inputs) {
    CloudRequest &request = requests.emplace_back();
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

// Subjects that stand together, and the image that shows them where labels tell
// them apart.
struct Group {
  std::vector<Subject> subjects;
  RgbdImage image;
};

Result<Group> ReadGroup(const CloudRequest &request, const std::string &labels) {
  auto cloud = ReadCloudFile(request.path);
  if (!cloud) return Error{request.where + cloud.error().message};
  Group group;
  if (labels.empty()) {
    group.subjects.push_back({request, std::move(cloud->points), {}});
    return group;
  }
  auto scene = ReadLabelledScene(*cloud, labels, request.table_F);
  if (!scene) return Error{request.path + " with --labels: " + scene.error().message};
  for (LabelledObject &object : scene->objects) {
    Subject &subject = group.subjects.emplace_back(
        Subject{request, std::move(object.points_C), std::move(object.rim_C)});
    subject.request.label = object.label;
    subject.request.table_F = scene->table_C;
  }
  group.image = std::move(scene->image);
  return group;
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Estimates `repeat` times; the results of each are the same, the times are
// medians.
std::vector<CloudPose> EstimateRepeatedly(const std::vector<Subject> &subjects, int repeat,
                                          const PoseConfig &config) {
  std::vector<FitInput> inputs;
  for (const Subject &subject : subjects) {
    inputs.push_back(
        {subject.points_F, subject.request.table_F, subject.request.viewpoint_F, subject.rim_F});
  }
  const Stopwatch stopwatch;
  std::vector<Estimate> estimates;
  std::vector<std::vector<double>> times_ms(subjects.size());
  for (int i = 0; i < std::max(repeat, 1); ++i) {
    estimates = EstimateScene(inputs, config, [&] { return stopwatch.Milliseconds(); });
    for (size_t k = 0; k < subjects.size(); ++k) times_ms[k].push_back(estimates[k].time_ms);
  }
  std::vector<CloudPose> poses;
  for (size_t k = 0; k < subjects.size(); ++k) {
    estimates[k].time_ms = Median(times_ms[k]);
    poses.push_back({subjects[k].request, std::move(estimates[k])});
  }
  return poses;
}

Status DrawLabelled(const std::string &path, const RgbdImage &image,
                    const std::vector<CloudPose> &poses, const GripperConfig &gripper) {
  std::vector<SceneObjectFit> objects;
  for (const CloudPose &pose : poses) {
    objects.push_back({std::to_string(pose.request.label), pose.estimate});
  }
  return DrawScene(path, image, objects, gripper);
}

// The surfaces of the fits that converged and of their parts, as one PLY file.
Status WriteMesh(const std::string &path, const std::vector<CloudPose> &poses) {
  constexpr int kSegments = 64;
  std::vector<MeshPiece> pieces;
  for (size_t i = 0; i < poses.size(); ++i) {
    const FitResult &fit = poses[i].estimate.fit;
    if (!fit.converged) continue;
    const int object = static_cast<int>(i) + 1;
    pieces.push_back({MakeMesh(fit.shape, kSegments), object, 0});
    for (const Superquadric &part : fit.parts) {
      const int number = pieces.back().part + 1;
      pieces.push_back({MakeMesh(part, kSegments), object, number});
    }
  }
  return WriteTextFile(path, MeshToPly(pieces));
}

}  // namespace

Status RunOffline(const OfflineOptions &options, const PoseConfig &config) {
  const auto requests = Requests(options);
  if (!requests) return requests.error();
  std::vector<CloudPose> poses;
  std::vector<Portrait> portraits;
  RgbdImage image;  // of the only input, where it is labelled
  for (const CloudRequest &request : *requests) {
    auto group = ReadGroup(request, options.labels);
    if (!group) return group.error();
    for (CloudPose &pose : EstimateRepeatedly(group->subjects, options.repeat, config)) {
      poses.push_back(std::move(pose));
    }
    image = std::move(group->image);
    if (options.picture.empty() || !options.labels.empty()) continue;
    portraits.push_back({std::filesystem::path(request.file).filename().string(),
                         std::move(group->subjects.front().points_F), request.table_F,
                         request.viewpoint_F, poses.back().estimate});
  }
  if (Status written = WriteTextFile(options.json, PosesToJson(poses, Name(config.fit.method)));
      !written) {
    return written;
  }
  if (!options.mesh.empty()) {
    if (Status written = WriteMesh(options.mesh, poses); !written) return written;
  }
  if (options.picture.empty()) return {};
  return options.labels.empty() ? DrawPortraits(options.picture, portraits, config.gripper)
                                : DrawLabelled(options.picture, image, poses, config.gripper);
}

}  // namespace beckon::pose
