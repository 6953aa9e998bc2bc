// The files of the offline mode: lists of clouds in, poses as JSON out.
#include "services/pose/pose_files.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace beckon::pose {
namespace {

using nlohmann::json;

Result<Plane> MakePlane(const std::vector<double>& values) {
  if (values.size() != 4) {
    return Error{"a plane has 4 numbers nx,ny,nz,d, found " + std::to_string(values.size())};
  }
  const Eigen::Vector3d normal(values[0], values[1], values[2]);
  const double length = normal.norm();
  if (!normal.allFinite() || !std::isfinite(values[3]) || length < 1e-6 || length > 1e6) {
    return Error{"a plane's normal nx,ny,nz is finite and not zero, and d is finite"};
  }
  return Plane{normal / length, values[3] / length};
}

// The numbers of an array; fails where `value` is anything else.
Result<std::vector<double>> Numbers(const json& value, const char* key) {
  std::vector<double> numbers;
  bool sound = value.is_array();
  for (size_t i = 0; sound && i < value.size(); ++i) {
    sound = value[i].is_number();
    if (sound) numbers.push_back(value[i].get<double>());
  }
  if (!sound) return Error{std::string("\"") + key + "\" is a list of numbers"};
  return numbers;
}

Result<CloudRequest> ParseLine(const std::string& line) {
  const json entry = json::parse(line, nullptr, false);
  if (!entry.is_object()) return Error{"expected a JSON object {\"file\": .., \"plane\": [..]}"};
  if (!entry.contains("file") || !entry["file"].is_string()) {
    return Error{"expected \"file\" with the name of a cloud"};
  }
  CloudRequest request;
  request.file = entry["file"].get<std::string>();
  if (entry.contains("plane") && !entry["plane"].is_null()) {
    const auto numbers = Numbers(entry["plane"], "plane");
    if (!numbers) return numbers.error();
    const auto plane = MakePlane(*numbers);
    if (!plane) return plane.error();
    request.table_F = *plane;
  }
  if (entry.contains("viewpoint") && !entry["viewpoint"].is_null()) {
    const auto numbers = Numbers(entry["viewpoint"], "viewpoint");
    if (!numbers) return numbers.error();
    if (numbers->size() != 3) return Error{"\"viewpoint\" has 3 numbers x, y, z"};
    request.viewpoint_F = Eigen::Vector3d(numbers->data());
  }
  return request;
}

json Array(const Eigen::Ref<const Eigen::VectorXd>& v) {
  return std::vector<double>(v.data(), v.data() + v.size());
}

json ToJson(const GraspCandidate& grasp) {
  return {{"position", Array(grasp.X_FG.translation())},
          {"rotation", QuaternionWxyz(grasp.X_FG)},
          {"opening_m", grasp.opening_m},
          {"score", grasp.score}};
}

json ToJson(const std::vector<Superquadric>& shapes_F) {
  json list = json::array();
  for (const Superquadric& shape : shapes_F) {
    list.push_back({{"position", Array(shape.X_FO.translation())},
                    {"rotation", QuaternionWxyz(shape.X_FO)},
                    {"semi_axes", Array(shape.semi_axes)},
                    {"epsilon", Array(shape.epsilon)},
                    {"taper", Array(shape.taper)}});
  }
  return list;
}

}  // namespace

Result<std::vector<CloudRequest>> ReadCloudList(const std::string& path) {
  std::ifstream file(path);
  if (!file) return Error{path + ": cannot be read"};
  std::vector<CloudRequest> requests;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::string where = path + ":" + std::to_string(number);
    auto request = ParseLine(line);
    if (!request) return Error{where + ": " + request.error().message};
    request->path = (std::filesystem::path(path).parent_path() / request->file).string();
    request->where = where + ": ";
    requests.push_back(*std::move(request));
  }
  if (file.bad()) return Error{path + ": cannot be read to its end"};
  if (requests.empty())
    return Error{path + ": names no cloud; expected a line {\"file\": ..} for each"};
  return requests;
}

Result<Plane> ParsePlane(const std::string& text) {
  std::vector<double> values;
  size_t begin = 0;
  while (begin <= text.size()) {
    const size_t end = std::min(text.find(',', begin), text.size());
    const std::string number = text.substr(begin, end - begin);
    char* rest = nullptr;
    values.push_back(std::strtod(number.c_str(), &rest));
    if (number.empty() || *rest != '\0') {
      return Error{"plane '" + text + "': expected nx,ny,nz,d, found '" + number + "'"};
    }
    begin = end + 1;
  }
  const auto plane = MakePlane(values);
  if (!plane) return Error{"plane '" + text + "': " + plane.error().message};
  return plane;
}

std::string PosesToJson(const std::vector<CloudPose>& poses, const std::string& method) {
  json list = json::array();
  for (const CloudPose& pose : poses) {
    const FitResult& fit = pose.estimate.fit;
    json covariance = json::array(), grasps = json::array();
    for (int i = 0; i < 6; ++i) covariance.push_back(Array(fit.covariance.row(i).transpose()));
    for (const auto& grasp : pose.estimate.grasps) grasps.push_back(ToJson(grasp));
    list.push_back({{"file", pose.request.file},
                    {"method", method},
                    {"position", Array(fit.shape.X_FO.translation())},
                    {"rotation", QuaternionWxyz(fit.shape.X_FO)},
                    {"semi_axes", Array(fit.shape.semi_axes)},
                    {"epsilon", Array(fit.shape.epsilon)},
                    {"taper", Array(fit.shape.taper)},
                    {"mean_radial_distance_m", fit.mean_radial_distance_m},
                    {"converged", fit.converged},
                    {"reason", fit.reason},
                    {"ambiguous", fit.ambiguous},
                    {"alternatives", ToJson(fit.alternatives)},
                    {"parts", ToJson(fit.parts)},
                    {"covariance", covariance},
                    {"grasps", grasps},
                    {"points", fit.points_used},
                    {"iterations", fit.iterations},
                    {"time_ms", pose.estimate.time_ms}});
    if (pose.request.label != 0) list.back()["label"] = pose.request.label;
  }
  // File names that are not UTF-8 are kept readable rather than refused.
  return list.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

Status WriteTextFile(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) return Error{path + ": cannot be written"};
  return {};
}

}  // namespace beckon::pose
