// The configuration file is strict.
#include "services/pose/pose_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace beckon::pose {
namespace {

using ::testing::HasSubstr;

Result<PoseConfig> Read(const std::string& text) {
  const auto table = ConfigTable::Parse(text, "pose.toml");
  if (!table) return table.error();
  return ReadPoseConfig(*table);
}

TEST(PoseConfigFile, IsDefaultsWhenEmpty) {
  const auto config = Read("");
  ASSERT_TRUE(config);
  EXPECT_EQ(config->gripper.max_opening_m, 0.10);
  EXPECT_EQ(config->fit.multiscale.voxels_m.size(), 3u);
}

TEST(PoseConfigFile, OverridesDefaults) {
  const auto config = Read(
      "method = 'multiscale'\n[multiscale]\nvoxels_m = [0.02]\n[gripper]\nmax_opening_m = 0.08\n"
      "finger_thickness_m = 0.012\npalm_width_m = 0.15\npalm_thickness_m = 0.07\n"
      "palm_depth_m = 0.1\napproach_m = 0.05\n"
      "[adaptive]\nfine_points = 200\n[limits]\nmax_extent_m = 1.0\n");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->fit.method, Method::kMultiscale);
  EXPECT_EQ(config->fit.multiscale.voxels_m, std::vector<double>{0.02});
  EXPECT_EQ(config->gripper.max_opening_m, 0.08);
  EXPECT_EQ(config->gripper.finger_thickness_m, 0.012);
  EXPECT_EQ(config->gripper.palm_width_m, 0.15);
  EXPECT_EQ(config->gripper.approach_m, 0.05);
  EXPECT_EQ(config->fit.adaptive.fine_points, 200);
}

TEST(PoseConfigFile, HasASectionForEveryMethod) {
  const auto config = Read(
      "method = 'hierarchical'\n[classic]\nmax_taper = 0.25\n"
      "[hierarchical]\nseed = 7\nvoxels_m = [0.02, 0.01]\n[multiscale]\nsmooth_m = 0.03\n");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->fit.method, Method::kHierarchical);
  EXPECT_EQ(config->fit.classic.max_taper, 0.25);
  EXPECT_EQ(config->fit.hierarchical.seed, 7);
  EXPECT_EQ(config->fit.hierarchical.voxels_m.size(), 2u);
  EXPECT_EQ(config->fit.multiscale.smooth_m, 0.03);
}

TEST(PoseConfigFile, BoundsTheShapesOfEveryMethod) {
  const std::string common = "min_semi_axis_m = 0.007\nmin_epsilon = 0.2\nmax_epsilon = 1.5\n";
  const std::string margin = common + "axis_margin_m = 0.02\n", taper = "max_taper = 0.1\n";
  const auto config = Read("[adaptive]\n" + common + "[multiscale]\n" + margin + taper +
                           "[classic]\n" + margin + taper + "[hierarchical]\n" + margin);
  ASSERT_TRUE(config) << config.error().message;
  const auto expect_common = [](const auto& c) {
    EXPECT_EQ(c.min_semi_axis_m, 0.007);
    EXPECT_EQ(c.min_epsilon, 0.2);
    EXPECT_EQ(c.max_epsilon, 1.5);
  };
  const FitConfig& fit = config->fit;
  expect_common(fit.adaptive), expect_common(fit.multiscale);
  expect_common(fit.classic), expect_common(fit.hierarchical);
  EXPECT_EQ(fit.multiscale.axis_margin_m, 0.02);
  EXPECT_EQ(fit.classic.axis_margin_m, 0.02);
  EXPECT_EQ(fit.hierarchical.axis_margin_m, 0.02);
  EXPECT_EQ(fit.multiscale.max_taper, 0.1);
  EXPECT_EQ(fit.classic.max_taper, 0.1);
  for (const char* text : {"[adaptive]\nmax_taper = 0.1", "[hierarchical]\nmax_taper = 0.1",
                           "[classic]\nmin_epsilon = 0.01", "[multiscale]\nmax_epsilon = 3"}) {
    EXPECT_FALSE(Read(text)) << text;
  }
}

TEST(PoseConfigFile, RefusesWhatItDoesNotKnow) {
  for (const char* text : {"methud = 'adaptive'", "[gripper]\nwidth = 1",
                           "[multiscale]\nvoxels_m = [0.0]", "[adaptive]\nfine_points = -1",
                           "[hierarchical]\nvoxels_m = [0.00001]", "[classic]\npoints = 10"}) {
    EXPECT_FALSE(Read(text)) << text;
  }
  const auto method = Read("method = 'guess'");
  ASSERT_FALSE(method);
  EXPECT_THAT(method.error().message, HasSubstr("adaptive, multiscale, classic, hierarchical"));
}

}  // namespace
}  // namespace beckon::pose
