// The pose service's configuration file.
#include "services/pose/pose_config.h"

#include <string>

namespace beckon::pose {
namespace {

// What the shapes of a method are kept within.
template <typename MethodConfig>
void ReadBounds(ConfigTable& table, MethodConfig& c) {
  table.Get("min_semi_axis_m", c.min_semi_axis_m, 1e-4, 0.1);
  table.Get("min_epsilon", c.min_epsilon, kMinEpsilon, 1);
  table.Get("max_epsilon", c.max_epsilon, 1, kMaxEpsilon);
  if constexpr (requires { c.axis_margin_m; }) table.Get("axis_margin_m", c.axis_margin_m, 0, 1);
  if constexpr (requires { c.max_taper; }) table.Get("max_taper", c.max_taper, 0, 0.9);
}

void ReadVoxels(ConfigTable& table, std::vector<double>& voxels_m) {
  table.Get("voxels_m", voxels_m);
  for (double voxel_m : voxels_m) {
    if (!(voxel_m >= 1e-4)) table.Fail("voxels_m", "every voxel is at least 0.0001 m long");
  }
}

void ReadAdaptive(ConfigTable table, AdaptiveConfig& c) {
  ReadBounds(table, c);
  table.Get("coarse_points", c.coarse_points, 20, 100000);
  table.Get("fine_points", c.fine_points, 20, 100000);
  table.Get("coarse_iterations", c.coarse_iterations, 1, 1000);
  table.Get("fine_iterations", c.fine_iterations, 1, 1000);
  table.Get("noise_m", c.noise_m, 1e-5, 0.1);
  table.Get("axis_margin", c.axis_margin, 0, 10);
  table.Get("volume_prior_m2", c.volume_prior_m2, 0, 1);
  table.Get("cut_ragged_m2", c.cut_ragged_m2, 0, 1);
  table.Get("top_slack_m", c.top_slack_m, 0, 1);
  table.Get("top_weight", c.top_weight, 0, 100);
  table.Get("proportion_prior_m2", c.proportion_prior_m2, 0, 1);
  table.Get("support_weight", c.support_weight, 0, 1e6);
  table.Get("support_noise_m", c.support_noise_m, 1e-5, 1);
  table.Get("unseen_foot_m", c.unseen_foot_m, 0, 10);
  table.Get("tilt_weight", c.tilt_weight, 0, 1e6);
  table.Get("outline_rays", c.outline_rays, 0, 1000);
  table.Get("outline_weight", c.outline_weight, 0, 1e6);
  table.Get("outline_noise_m", c.outline_noise_m, 1e-5, 0.1);
  table.Get("outline_outside_m", c.outline_outside_m, 1e-5, 0.1);
  table.Get("cut_hypotheses", c.cut_hypotheses);
  table.Get("outline_trust_m2", c.outline_trust_m2, 0, 1);
  table.Get("runner_up", c.runner_up, 1, 1000);
  table.Get("fine_tolerance", c.fine_tolerance, 1e-9, 1);
  table.Get("witnesses", c.witnesses, 1, 1e6);
  table.Get("outline_clean_m2", c.outline_clean_m2, 1e-12, 1);
  table.Get("cut_pull_m2", c.cut_pull_m2, 0, 1);
  table.Get("cut_charge_m2", c.cut_charge_m2, 0, 1);
  table.Get("cut_beyond", c.cut_beyond, 0, 10);
  table.Get("cut_sigma", c.cut_sigma, 1e-3, 10);
  table.Get("cut_iterations", c.cut_iterations, 1, 1000);
  table.Get("pixel_rad", c.pixel_rad, 0, 0.1);
  table.Get("table_margin_m", c.table_margin_m, 0, 1);
}

void ReadMultiscale(ConfigTable table, MultiscaleConfig& c) {
  ReadBounds(table, c);
  ReadVoxels(table, c.voxels_m);
  table.Get("smooth_m", c.smooth_m, 0, 1);
  table.Get("max_iterations", c.max_iterations, 1, 1000);
  table.Get("stop_change", c.stop_change, 0, 1);
}

void ReadClassic(ConfigTable table, ClassicConfig& c) {
  ReadBounds(table, c);
  table.Get("points", c.points, 20, 100000);
  table.Get("max_iterations", c.max_iterations, 1, 1000);
  table.Get("tolerance", c.tolerance, 0, 1);
}

void ReadHierarchical(ConfigTable table, HierarchicalConfig& c) {
  ReadBounds(table, c);
  ReadVoxels(table, c.voxels_m);
  table.Get("hypotheses", c.hypotheses, 1, 100000);
  table.Get("keep", c.keep, 0, 1);
  table.Get("min_region", c.min_region, 0, 1);
  table.Get("sample_points", c.sample_points, 20, 100000);
  table.Get("sample_iterations", c.sample_iterations, 1, 1000);
  table.Get("level_iterations", c.level_iterations, 1, 1000);
  table.Get("fine_points", c.fine_points, 20, 100000);
  table.Get("fine_iterations", c.fine_iterations, 1, 1000);
  table.Get("inlier_m", c.inlier_m, 1e-5, 0.1);
  table.Get("seed", c.seed, 0);
}

void ReadParts(ConfigTable table, PartsConfig& c) {
  table.Get("most_parts", c.most_parts, 1, 10);
  table.Get("outside_m", c.outside_m, 1e-4, 1);
  table.Get("outside_sigmas", c.outside_sigmas, 0, 100);
  table.Get("outside_medians", c.outside_medians, 0, 100);
  table.Get("min_points", c.min_points, kParameters, 512);
  table.Get("min_share", c.min_share, 0, 1);
  table.Get("min_protrusion_m", c.min_protrusion_m, 0, 1);
  table.Get("neck_width", c.neck_width, 0, 1);
  table.Get("neck_height_m", c.neck_height_m, 0, 1);
  table.Get("astray_sigmas", c.astray_sigmas, 1, 100);
  table.Get("round_share", c.round_share, 0, 1);
  table.Get("rounds", c.rounds, 1, 100);
  table.Get("iterations", c.iterations, 1, 1000);
  table.Get("min_semi_axis_m", c.min_semi_axis_m, 1e-4, 0.1);
  table.Get("witnesses", c.witnesses, 2, 512);
}

void ReadGripper(ConfigTable table, GripperConfig& c) {
  table.Get("max_opening_m", c.max_opening_m, 0.001, 1);
  table.Get("finger_depth_m", c.finger_depth_m, 0.001, 1);
  table.Get("finger_half_width_m", c.finger_half_width_m, 0, 1);
  table.Get("finger_thickness_m", c.finger_thickness_m, 0, 1);
  table.Get("palm_width_m", c.palm_width_m, 0, 1);
  table.Get("palm_thickness_m", c.palm_thickness_m, 0, 1);
  table.Get("palm_depth_m", c.palm_depth_m, 0, 1);
  table.Get("approach_m", c.approach_m, 0, 1);
  table.Get("clearance_m", c.clearance_m, 0, 1);
  table.Get("max_slip_rad", c.max_slip_rad, 0, 1.6);
}

}  // namespace

Result<PoseConfig> ReadPoseConfig(ConfigTable table) {
  PoseConfig config;
  std::string method = Name(config.fit.method);
  table.Get("method", method);
  const Result<Method> parsed = ParseMethod(method);
  if (parsed) {
    config.fit.method = *parsed;
  } else {
    table.Fail("method", parsed.error().message);
  }
  ConfigTable limits = table.Section("limits");
  limits.Get("max_extent_m", config.fit.max_extent_m, 0.01, 100);
  limits.Get("min_extent_m", config.fit.min_extent_m, 0, 1);
  limits.Get("max_radial_distance_m", config.fit.max_radial_distance_m, 0, 1);
  limits.Get("max_below_share", config.fit.max_below_share, 0, 1);
  limits.Get("below_table_m", config.fit.below_table_m, 0, 1);
  ReadAdaptive(table.Section("adaptive"), config.fit.adaptive);
  ReadMultiscale(table.Section("multiscale"), config.fit.multiscale);
  ReadClassic(table.Section("classic"), config.fit.classic);
  ReadHierarchical(table.Section("hierarchical"), config.fit.hierarchical);
  ReadParts(table.Section("parts"), config.fit.parts);
  ReadGripper(table.Section("gripper"), config.gripper);
  if (Status finished = table.Finish(); !finished) return finished.error();
  return config;
}

}  // namespace beckon::pose
