#include "services/base/scene_truth.h"

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

namespace beckon {
namespace {

// How far beyond its box, or from its centroid, a segment still shows the object.
constexpr double kBoxReach_m = 0.02;
constexpr double kCentroidReach_m = 0.06;

std::optional<Eigen::Vector3d> ParseVector(const nlohmann::json& entry, const char* key) {
  if (!entry.is_object() || !entry.contains(key)) return {};
  const auto& array = entry[key];
  if (!array.is_array() || array.size() != 3) return {};
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) {
    if (!array[i].is_number()) return {};
    vector[i] = array[i].get<double>();
  }
  if (!vector.allFinite()) return {};
  return vector;
}

std::optional<TruthObject> ParseObject(const nlohmann::json& entry) {
  const auto centroid = ParseVector(entry, "centroid_C");
  if (!centroid || !entry.contains("category") || !entry["category"].is_string()) return {};
  TruthObject object{
      .category = entry["category"].get<std::string>(), .centroid_C = *centroid, .box_C = {}};
  if (entry.contains("box_C")) {
    const auto min = ParseVector(entry["box_C"], "min"), max = ParseVector(entry["box_C"], "max");
    if (!min || !max) return {};
    object.box_C = Eigen::AlignedBox3d(*min, *max);
  }
  return object;
}

}  // namespace

std::optional<size_t> SceneTruth::At(const Eigen::Vector3d& p_C) const {
  std::optional<size_t> best;
  double best_distance = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < objects.size(); ++i) {
    const double distance = (objects[i].centroid_C - p_C).norm();
    const bool shows = objects[i].box_C.isEmpty()
                           ? distance <= kCentroidReach_m
                           : objects[i].box_C.exteriorDistance(p_C) <= kBoxReach_m;
    if (shows && distance < best_distance) {
      best_distance = distance;
      best = i;
    }
  }
  return best;
}

std::optional<size_t> SceneTruth::FirstInstance(const std::string& category,
                                                const Pose& X_WC) const {
  std::optional<size_t> best;
  double best_distance = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].category != category) continue;
    const double distance = (X_WC * objects[i].centroid_C).head<2>().norm();
    if (distance < best_distance) {
      best_distance = distance;
      best = i;
    }
  }
  return best;
}

Result<SceneTruth> ReadSceneTruth(const std::string& path) {
  std::ifstream file(path);
  if (!file)
    return Error{
        path + ": cannot be read; expected the ground truth that 'beckon-capture --truth' writes"};
  std::stringstream text;
  text << file.rdbuf();
  const auto json = nlohmann::json::parse(text.str(), nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || !json.contains("objects")) {
    return Error{path + R"(: expected JSON {"objects": [..] | null}, found something else)"};
  }
  const auto& objects = json["objects"];
  SceneTruth truth;
  if (objects.is_null()) return truth;
  if (!objects.is_array()) return Error{path + ": \"objects\" is neither a list nor null"};
  truth.known = true;
  for (const auto& entry : objects) {
    auto object = ParseObject(entry);
    if (!object) {
      return Error{path + ": object " + std::to_string(truth.objects.size() + 1) +
                   R"(: expected "category" (text) and "centroid_C" (three finite numbers, m))"};
    }
    truth.objects.push_back(*std::move(object));
  }
  return truth;
}

}  // namespace beckon
