// Names and configuration of segmentation, and the choice of its method.
#include "services/perception/segmentation.h"

#include "services/base/config.h"
#include "services/perception/segmentation_reference.h"

namespace beckon::perception {

const char* Name(SegmentationMethod) { return "reference"; }

Result<SegmentationMethod> ParseSegmentationMethod(const std::string& name) {
  if (name == "reference") return SegmentationMethod::kReference;
  return Error{"segmentation: there is no method '" + name + "' in this build; it has: reference"};
}

void ReadConfig(ConfigTable& root, SegmentationConfig& config) {
  ConfigTable table = root.Section("segmentation");
  std::string method = Name(config.method);
  table.Get("method", method);
  if (auto parsed = ParseSegmentationMethod(method)) {
    config.method = *parsed;
  } else {
    table.Fail("method", parsed.error().message);
  }
  table.Get("min_range_m", config.min_range_m, 0, 100);
  table.Get("max_range_m", config.max_range_m, 0, 100);
  if (config.min_range_m >= config.max_range_m) {
    table.Fail("max_range_m", "must be greater than min_range_m");
  }
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
  table.Get("max_objects", config.max_objects, 1, 64);
}

Segmentation Segment(const RgbdImage& image, const SegmentationConfig& config,
                     const StepObserver& done) {
  return SegmentReference(image, config, done);
}

}  // namespace beckon::perception
