// Reads beckon-perception's configuration and what it names.
#include "services/perception/perception_config.h"

#include <algorithm>

#include "services/base/app.h"

namespace beckon::perception {
namespace {

/// Errors are left for ConfigTable::Finish.
void ReadSegmentation(ConfigTable table, SegmentationConfig& config) {
  std::string method = Name(config.method);
  table.Get("method", method);
  if (auto parsed = ParseSegmentationMethod(method)) {
    config.method = *parsed;
  } else {
    table.Fail("method", parsed.error().message);
  }
  table.Get("min_range_m", config.min_range_m, 0.01, 100);
  table.Get("max_range_m", config.max_range_m, 0, 100);
  if (config.min_range_m >= config.max_range_m) {
    table.Fail("max_range_m", "must be greater than min_range_m");
  }
  table.Get("reference_min_range_m", config.reference_min_range_m, 0, 100);
  if (config.reference_min_range_m >= config.max_range_m) {
    table.Fail("max_range_m", "must be greater than reference_min_range_m");
  }
  table.Get("noise_floor_m", config.sensor.floor_m, 0.00001, 0.1);
  table.Get("noise_growth_per_m", config.sensor.growth_per_m, 0, 0.1);
  table.Get("noise_from_m", config.sensor.from_m, 0, 10);
  table.Get("min_object_m2", config.min_object_m2, 0.000001, 1);
  table.Get("voxel_m", config.voxel_m, 0.0005, 0.1);
  table.Get("use_normals", config.use_normals);
  table.Get("normal_neighbours", config.normal_neighbours, 3, 1000);
  table.Get("normal_weight", config.normal_weight, 0, 1);
  table.Get("plane_distance_m", config.plane_distance_m, 0.0005, 0.1);
  table.Get("plane_iterations", config.plane_iterations, 1, 1'000'000);
  table.Get("plane_min_points", config.plane_min_points, 3, 10'000'000);
  table.Get("table_max_tilt_deg", config.table_max_tilt_deg, 0, 180);
  table.Get("table_gap_m", config.table_gap_m, 0.01, 10);
  table.Get("min_height_m", config.min_height_m, 0.0005, 1);
  table.Get("max_height_m", config.max_height_m, 0.001, 3);
  if (config.min_height_m >= config.max_height_m) {
    table.Fail("max_height_m", "must be greater than min_height_m");
  }
  table.Get("cluster_tolerance_m", config.cluster_tolerance_m, 0.0005, 0.5);
  table.Get("cluster_min_points", config.cluster_min_points, 1, 10'000'000);
  table.Get("border_m", config.border_m, 0, 1);
  table.Get("max_objects", config.max_objects, 1, 64);
}

void ReadTracker(ConfigTable tracker, PerceiverConfig& config) {
  tracker.Get("max_step_m", config.tracker.max_step_m, 0.001, 1);
  tracker.Get("min_overlap", config.tracker.min_overlap, 0.01, 1);
  tracker.Get("max_jump_m", config.tracker.max_jump_m, 0, 10);
  tracker.Get("min_likeness", config.tracker.min_likeness, 0, 1);
  tracker.Get("forget_after_frames", config.tracker.forget_after_frames, 1, 1'000'000);
  tracker.Get("steady", config.tracker.steady);
  tracker.Get("settle_after_frames", config.tracker.settle_after_frames, 1, 100);
  tracker.Get("recategorise_step_m", config.recategorise_step_m, 0, 1);
  tracker.Get("recategorise_growth", config.recategorise_growth, 0, 10);
}

}  // namespace

Result<PerceptionConfig> ReadPerceptionConfig(ConfigTable root, const Overrides& overrides) {
  PerceptionConfig config;
  root.Get("threads", config.perceiver.threads, 1, 64);
  ReadSegmentation(root.Section("segmentation"), config.perceiver.segmentation);
  ReadTracker(root.Section("tracker"), config.perceiver);
  ConfigTable categoriser = root.Section("categoriser");
  categoriser.Get("enabled", config.categories);
  categoriser.Get("model", config.model);
  categoriser.Get("cues", config.cues);
  categoriser.Get("unknown_prior", config.unknown_prior, -1, 1000);
  categoriser.Get("ask_at_or_below", config.ask_at_or_below, -1, 1);
  ConfigTable learning = root.Section("learning");
  learning.Get("folder", config.learning.folder);
  learning.Get("most_views", config.learning.most_views, 1, 1'000'000);
  learning.Get("views_per_object", config.perceiver.views_per_object, 1, 100);
  learning.Get("dependence", config.perceiver.evidence.dependence, 0, 1);
  if (Status status = root.Finish(); !status) return status.error();
  if (!overrides.segmentation.empty()) {
    auto method = ParseSegmentationMethod(overrides.segmentation);
    if (!method) return Error{"--" + method.error().message};
    config.perceiver.segmentation.method = *method;
  }
  if (overrides.no_categories) config.categories = false;
  if (!overrides.model.empty()) config.model = overrides.model;
  if (!overrides.cues.empty()) config.cues = overrides.cues;
  if (!overrides.examples.empty()) config.learning.folder = overrides.examples;
  if (config.learning.folder == "auto") config.learning.folder = DataFile("examples");
  if (overrides.threads > 0) config.perceiver.threads = overrides.threads;
  return config;
}

Result<std::optional<Categoriser>> LoadCategoriser(const PerceptionConfig& config) {
  if (!config.categories) return std::optional<Categoriser>();
  const std::string file = config.model.empty() ? SharedFile("categories.model") : config.model;
  auto categoriser = Categoriser::Load(file);
  if (!categoriser) {
    return Error{categoriser.error().message + "; or go without by --no-categories"};
  }
  if (Status status = categoriser->UseCues(config.cues); !status) {
    return Error{file + ": " + status.error().message};
  }
  if (config.unknown_prior >= 0) {
    categoriser->set_unknown_prior(static_cast<float>(std::max(config.unknown_prior, 0.001)));
  }
  if (config.ask_at_or_below >= 0) {
    categoriser->set_threshold(static_cast<float>(config.ask_at_or_below));
  }
  return std::optional<Categoriser>(*std::move(categoriser));
}

}  // namespace beckon::perception
