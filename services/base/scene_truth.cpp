#include "services/base/scene_truth.h"

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

namespace beckon {
namespace {

std::optional<TruthObject> ParseObject(const nlohmann::json& entry) {
  if (!entry.is_object() || !entry.contains("category") || !entry["category"].is_string())
    return {};
  if (!entry.contains("centroid_C")) return {};
  const auto& centroid = entry["centroid_C"];
  if (!centroid.is_array() || centroid.size() != 3) return {};
  TruthObject object;
  object.category = entry["category"].get<std::string>();
  for (int i = 0; i < 3; ++i) {
    if (!centroid[i].is_number()) return {};
    object.centroid_C[i] = centroid[i].get<double>();
  }
  if (!object.centroid_C.allFinite()) return {};
  return object;
}

}  // namespace

std::optional<size_t> SceneTruth::Nearest(const Eigen::Vector3d& p_C, double reach_m) const {
  std::optional<size_t> best;
  double best_distance = reach_m;
  for (size_t i = 0; i < objects.size(); ++i) {
    const double distance = (objects[i].centroid_C - p_C).norm();
    if (distance <= best_distance) {
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
