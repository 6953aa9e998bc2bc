// Where the milliseconds go: every stage from a file on disk to a question, on one scene, in one
// process and one thread. Prints a table of medians and writes JSON.
#include <sys/utsname.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lcmtypes/codec.h"
#include "lcmtypes/frame_image.h"
#include "services/base/app.h"
#include "services/base/cloud_file.h"
#include "services/base/utime.h"
#include "services/perception/perceiver.h"
#include "services/perception/scene_message.h"
#include "services/pose/estimate.h"

namespace beckon {
namespace {

struct Options {
  std::string input;
  std::string model = SharedFile("categories.model");
  std::string json;
  int repeat = 15;
};

/// Collects durations by stage, in the order the stages first appear.
class Table {
 public:
  void Add(const std::string& stage, double ms) {
    if (!times_.contains(stage)) order_.push_back(stage);
    times_[stage].push_back(ms);
  }

  template <typename Work>
  auto Time(const std::string& stage, Work work) {
    const Stopwatch watch;
    auto result = work();
    Add(stage, watch.Milliseconds());
    return result;
  }

  void Print() const {
    std::printf("%-36s %10s %10s %10s %6s\n", "stage", "median ms", "min", "max", "runs");
    for (const auto& stage : order_) {
      const auto sorted = Sorted(stage);
      std::printf("%-36s %10.3f %10.3f %10.3f %6zu\n", stage.c_str(), sorted[sorted.size() / 2],
                  sorted.front(), sorted.back(), sorted.size());
    }
  }

  nlohmann::ordered_json ToJson() const {
    nlohmann::ordered_json stages;
    for (const auto& stage : order_) {
      const auto sorted = Sorted(stage);
      stages[stage] = {{"median_ms", sorted[sorted.size() / 2]},
                       {"min_ms", sorted.front()},
                       {"max_ms", sorted.back()},
                       {"runs", sorted.size()}};
    }
    return stages;
  }

 private:
  std::vector<double> Sorted(const std::string& stage) const {
    std::vector<double> sorted = times_.at(stage);
    std::ranges::sort(sorted);
    return sorted;
  }

  std::vector<std::string> order_;
  std::map<std::string, std::vector<double>> times_;
};

/// Image to frame, over the wire, and back.
Result<RgbdImage> Travel(const RgbdImage& image, Table& table) {
  msg::Frame frame{.utime = 1, .seq = 1, .source = "bench"};
  if (Status s = table.Time("capture: compress image",
                            [&] { return EncodeImage(image, 1e-4, 90, frame); });
      !s) {
    return s.error();
  }
  const auto bytes =
      table.Time("frame: encode, checksum", [&] { return Codec<msg::Frame>::Encode(frame); });
  if (!bytes) return bytes.error();
  const auto arrived =
      table.Time("frame: check, decode", [&] { return Codec<msg::Frame>::Decode(*bytes); });
  if (!arrived) return arrived.error();
  return table.Time("perception: decompress image", [&] { return DecodeImage(*arrived); });
}

void Perceive(const RgbdImage& image, const perception::Categoriser& categoriser, Table& table,
              perception::Perception& perceived) {
  perception::PerceiverConfig config;
  // A new perceiver each time: nothing is remembered from the run before.
  perception::Perceiver perceiver(config, &categoriser);
  perceived = perceiver.Perceive(image);
  for (const auto& [step, ms] : perceived.steps_ms) table.Add("segmentation: " + step, ms);
  table.Add("segmentation: all", perceived.segmentation_ms);
  for (const auto& object : perceived.objects) {
    for (const auto& cue : object.category.cues)
      table.Add("category: " + cue.name + ", an object", cue.milliseconds);
    table.Add("category: all cues, an object", object.category.milliseconds);
  }
  table.Add("category: all objects", perceived.categorisation_ms);
}

void FitPoses(const msg::Scene& scene, Table& table) {
  const Stopwatch all;
  std::vector<pose::FitInput> inputs;
  for (const auto& object : scene.objects) {
    pose::FitInput& input = inputs.emplace_back();
    input.points_F = object.points_C;
    input.rim_F = object.rim_C;
    const Eigen::Vector3d up_C = scene.X_WC.linear().row(2);
    input.table_F = Plane{.normal = up_C, .offset_m = scene.X_WC.translation().z()};
  }
  for (const auto& estimate : pose::EstimateScene(inputs, {}, [&] { return all.Milliseconds(); })) {
    table.Add("pose: fit and grasps, an object", estimate.time_ms);
  }
  table.Add("pose: all objects", all.Milliseconds());
}

Status Run(const Options& options) {
  const auto categoriser = perception::Categoriser::Load(options.model);
  if (!categoriser) return categoriser.error();
  Table table;
  size_t n_objects = 0;
  for (int i = 0; i < options.repeat; ++i) {
    const auto cloud =
        table.Time("capture: read file", [&] { return ReadCloudFile(options.input); });
    if (!cloud) return cloud.error();
    const auto image = table.Time("capture: cloud to image", [&] { return ToImage(*cloud); });
    if (!image) return image.error();
    const auto received = Travel(*image, table);
    if (!received) return received.error();
    perception::Perception perceived;
    Perceive(*received, *categoriser, table, perceived);
    n_objects = perceived.objects.size();
    msg::Scene scene = table.Time("scene: build message",
                                  [&] { return perception::MakeScene(*received, perceived); });
    scene.utime = scene.seq = scene.frame_seq = 1;
    const auto bytes =
        table.Time("scene: encode", [&] { return Codec<msg::Scene>::Encode(scene); });
    if (!bytes) return bytes.error();
    const auto arrived =
        table.Time("scene: check, decode", [&] { return Codec<msg::Scene>::Decode(*bytes); });
    if (!arrived) return arrived.error();
    FitPoses(*arrived, table);
  }
  std::printf("%s: %zu objects, one thread\n",
              std::filesystem::path(options.input).filename().c_str(), n_objects);
  table.Print();
  if (!options.json.empty()) {
    utsname machine{};
    uname(&machine);
    nlohmann::ordered_json out = {{"version", VersionString()}, {"machine", machine.nodename},
                                  {"kernel", machine.release},  {"input", options.input},
                                  {"objects", n_objects},       {"stages", table.ToJson()}};
    std::ofstream(options.json) << out.dump(1) << '\n';
  }
  return {};
}

}  // namespace
}  // namespace beckon

int main(int argc, char** argv) {
  CLI::App app("Times every stage from a file to poses on one scene", "beckon-bench-stages");
  beckon::AppOptions common;
  beckon::AddAppOptions(app, common);
  beckon::Options options;
  app.add_option("--input", options.input, "PCD or PLY scene")->required();
  app.add_option("--model", options.model, "Category model")->capture_default_str();
  app.add_option("--repeat", options.repeat, "Runs, of which the median is shown")
      ->capture_default_str();
  app.add_option("--json", options.json, "Write the figures here as well");
  return beckon::RunApp(app, argc, argv, common, [&] { return beckon::Run(options); });
}
