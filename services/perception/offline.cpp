// The offline mode of beckon-perception.
#include "services/perception/offline.h"

#include <algorithm>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "lcmtypes/messages.h"
#include "services/base/cloud_file.h"
#include "services/perception/picture.h"

namespace beckon::perception {
namespace {

using Json = nlohmann::ordered_json;

Json Numbers(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// A float as a person wrote it: 0.1, not 0.10000000149.
double Short(float number) { return std::stod(std::to_string(number)); }

Json ObjectJson(const PerceivedObject& object) {
  Json json;
  json["id"] = object.id;
  json["points"] = object.shape.pixels.size();
  json["centroid_C"] = Numbers(object.shape.centroid_C);
  json["category"] =
      object.categorised ? object.category.probabilities.front().first : msg::kUnknownCategory;
  json["confidence"] = Short(object.category.confidence);
  json["probabilities"] = Json::object();
  for (const auto& [name, probability] : object.category.probabilities) {
    json["probabilities"][name] = Short(probability);
  }
  json["ask_user"] = object.category.ask_user;
  return json;
}

double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

struct Timed {
  Perception perception;  // of the last run, with the medians as its times
  double total_ms = 0;
};

/// Every run starts anew: nothing is remembered of the last.
Timed PerceiveRepeatedly(const RgbdImage& image, PerceiverConfig config,
                         const Categoriser* categoriser, int repeat) {
  config.remember = false;
  Timed result;
  std::vector<double> segmentation_ms, categorisation_ms, total_ms;
  std::vector<std::vector<double>> steps_ms;
  for (int i = 0; i < repeat; ++i) {
    Perceiver perceiver(config, categoriser);
    result.perception = perceiver.Perceive(image);
    const Perception& p = result.perception;
    segmentation_ms.push_back(p.segmentation_ms);
    categorisation_ms.push_back(p.categorisation_ms);
    total_ms.push_back(p.segmentation_ms + p.categorisation_ms);
    steps_ms.resize(p.steps_ms.size());
    for (size_t s = 0; s < p.steps_ms.size(); ++s) steps_ms[s].push_back(p.steps_ms[s].second);
  }
  result.perception.segmentation_ms = Median(segmentation_ms);
  result.perception.categorisation_ms = Median(categorisation_ms);
  result.total_ms = Median(total_ms);
  for (size_t s = 0; s < steps_ms.size(); ++s) {
    result.perception.steps_ms[s].second = Median(steps_ms[s]);
  }
  return result;
}

Json PerceptionJson(const Perception& perception, double total_ms) {
  Json json;
  if (const auto& table_C = perception.segmentation.table_C) {
    json["table"] = {{"normal", Numbers(table_C->normal)}, {"offset_m", table_C->offset_m}};
  } else {
    json["table"] = nullptr;
    json["reason"] = perception.segmentation.reason;
  }
  json["objects"] = Json::array();
  for (const auto& object : perception.objects) json["objects"].push_back(ObjectJson(object));
  json["timing_ms"] = {{"segmentation", perception.segmentation_ms},
                       {"categorisation", perception.categorisation_ms},
                       {"total", total_ms}};
  json["steps_ms"] = Json::object();
  for (const auto& [step, ms] : perception.steps_ms) json["steps_ms"][step] = ms;
  return json;
}

Status WriteText(const std::string& path, const std::string& text) {
  if (path.empty()) {
    std::cout << text;
    return {};
  }
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) return Error{path + ": cannot write the result; is the folder there and writable?"};
  return {};
}

}  // namespace

std::string ToJson(const Perception& perception) {
  return PerceptionJson(perception, perception.segmentation_ms + perception.categorisation_ms)
             .dump(1) +
         "\n";
}

Status ListCategories(const PerceptionConfig& config) {
  auto categoriser = LoadCategoriser(config);
  if (!categoriser) return categoriser.error();
  if (!categoriser->has_value()) return {};
  for (const auto& name : (*categoriser)->categories()) std::cout << name << "\n";
  return {};
}

Status PerceiveFile(const OfflineOptions& options, const PerceptionConfig& config) {
  auto cloud = ReadCloudFile(options.input);
  if (!cloud) return cloud.error();
  auto image = ToImage(*cloud);
  if (!image) return Error{options.input + ": " + image.error().message};
  auto categoriser = LoadCategoriser(config);
  if (!categoriser) return categoriser.error();

  const Timed timed =
      PerceiveRepeatedly(*image, config.perceiver,
                         categoriser->has_value() ? &**categoriser : nullptr, options.repeat);
  const std::string json = PerceptionJson(timed.perception, timed.total_ms).dump(1) + "\n";
  if (Status status = WriteText(options.json_file, json); !status) return status;
  if (!options.labels_file.empty()) {
    if (Status s = WriteLabels(options.labels_file, *image, timed.perception); !s) return s;
  }
  if (!options.picture_file.empty()) {
    const Status s =
        options.stage.empty()
            ? WritePicture(options.picture_file, *image, timed.perception)
            : WriteStagePicture(options.picture_file, *image, config.perceiver.segmentation,
                                timed.perception, options.stage);
    if (!s) return s;
  }
  return {};
}

}  // namespace beckon::perception
