#include "services/capture/description_json.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace beckon::capture {
namespace {

using Json = nlohmann::ordered_json;

Json FromVector(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json FromPose(const std::optional<Pose>& pose) {
  if (!pose) return nullptr;
  return {{"position", FromVector(pose->translation())}, {"rotation_wxyz", QuaternionWxyz(*pose)}};
}

Eigen::Vector3d ToVector(const Json& json) {
  const auto v = json.get<std::array<double, 3>>();
  return {v[0], v[1], v[2]};
}

std::optional<Pose> ToPose(const Json& json) {
  if (json.is_null()) return std::nullopt;
  auto pose = MakePose(json.at("position").get<std::array<double, 3>>(),
                       json.at("rotation_wxyz").get<std::array<double, 4>>());
  if (!pose) throw std::invalid_argument(pose.error().message);
  return *pose;
}

SceneDescription FromJson(const Json& json) {
  SceneDescription description;
  if (!json.at("table").is_null()) {
    description.table_C = Plane{ToVector(json.at("table").at("normal")),
                                json.at("table").at("offset_m").get<double>()};
  }
  const Json& k = json.at("intrinsics");
  description.intrinsics = {k.at("fx").get<double>(), k.at("fy").get<double>(),
                            k.at("cx").get<double>(), k.at("cy").get<double>()};
  if (json.at("objects").is_null()) return description;
  description.known = true;
  for (const Json& entry : json.at("objects")) {
    DescribedObject object;
    object.label = entry.at("label").get<int>();
    object.category = entry.at("category").get<std::string>();
    object.centroid_C = ToVector(entry.at("centroid_C"));
    object.box_C = {ToVector(entry.at("box_C").at("min")), ToVector(entry.at("box_C").at("max"))};
    object.visible_points = entry.at("visible_points").get<int>();
    object.X_CO = ToPose(entry.at("X_CO"));
    object.X_WO = ToPose(entry.at("X_WO"));
    description.objects.push_back(object);
  }
  return description;
}

Result<Json> ReadJson(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return Error{path + ": cannot be opened"};
  std::ostringstream text;
  text << file.rdbuf();
  Json json = Json::parse(text.str(), nullptr, false);
  if (json.is_discarded()) return Error{path + ": expected JSON, found something else"};
  return json;
}

}  // namespace

std::string ToJson(const SceneDescription& description) {
  Json json;
  json["table"] = nullptr;
  if (description.table_C) {
    json["table"] = {{"normal", FromVector(description.table_C->normal)},
                     {"offset_m", description.table_C->offset_m}};
  }
  const Intrinsics& k = description.intrinsics;
  json["intrinsics"] = {{"fx", k.fx}, {"fy", k.fy}, {"cx", k.cx}, {"cy", k.cy}};
  json["objects"] = nullptr;
  if (description.known) json["objects"] = Json::array();
  for (const DescribedObject& object : description.objects) {
    json["objects"].push_back(
        {{"label", object.label},
         {"category", object.category},
         {"centroid_C", FromVector(object.centroid_C)},
         {"box_C",
          {{"min", FromVector(object.box_C.min())}, {"max", FromVector(object.box_C.max())}}},
         {"visible_points", object.visible_points},
         {"X_CO", FromPose(object.X_CO)},
         {"X_WO", FromPose(object.X_WO)}});
  }
  return json.dump(1) + "\n";
}

Result<SceneDescription> ReadDescription(const std::string& path) {
  const auto json = ReadJson(path);
  if (!json) return json.error();
  try {
    return FromJson(*json);
  } catch (const std::exception& error) {
    return Error{path + ": expected the ground truth of a rendered frame: " + error.what()};
  }
}

Result<std::map<int, std::string>> ReadCategories(const std::string& path,
                                                  const std::string& stem) {
  const auto json = ReadJson(path);
  if (!json) return json.error();
  try {
    std::map<int, std::string> categories;
    if (!json->contains(stem)) return categories;
    for (const auto& [number, category] : json->at(stem).items()) {
      categories[std::stoi(number)] = category.get<std::string>();
    }
    return categories;
  } catch (const std::exception& error) {
    return Error{path + R"(: expected {"file": {"object number": "category"}}: )" + error.what()};
  }
}

}  // namespace beckon::capture
