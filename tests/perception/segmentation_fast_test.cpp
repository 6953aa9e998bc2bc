// What the fast segmentation tells apart and puts together.
#include "services/perception/segmentation_fast.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "tests/perception/box_world.h"

namespace beckon::perception {
namespace {

/// The table with these on it, as a Kinect sees them.
BoxWorld TableWith(const std::vector<WorldBox>& boxes, const std::vector<WorldCup>& cups = {}) {
  BoxWorld world;
  world.boxes = {Table()};
  world.boxes.insert(world.boxes.end(), boxes.begin(), boxes.end());
  world.cups = cups;
  world.width = 640;
  world.height = 480;
  world.noise_m = kKinectNoise_m;
  return world;
}

/// The labels that more than a tenth of each thing's pixels have (things from 2 on; 1 is the
/// table).
std::map<int, std::set<int>> LabelsOf(const std::vector<int>& thing_of_pixel,
                                      const Segmentation& segmentation) {
  std::map<int, std::map<int, int>> counts;
  std::map<int, int> sizes;
  for (size_t i = 0; i < thing_of_pixel.size(); ++i) {
    if (thing_of_pixel[i] < 2) continue;
    ++counts[thing_of_pixel[i]][segmentation.labels[i]];
    ++sizes[thing_of_pixel[i]];
  }
  std::map<int, std::set<int>> labels;
  for (const auto& [thing, of] : counts) {
    for (const auto& [label, n] : of) {
      if (10 * n > sizes[thing]) labels[thing].insert(label);
    }
  }
  return labels;
}

/// Every thing on the table has one label, and no two have the same.
void ExpectOneObjectEach(const BoxWorld& world, const SegmentationConfig& config = {}) {
  std::vector<int> truth;
  const RgbdImage image = world.Render(&truth);
  const Segmentation result = SegmentFast(image, config);
  ASSERT_TRUE(result.table_C) << result.reason;
  const size_t n = world.boxes.size() - 1 + world.cups.size();
  EXPECT_EQ(result.n_objects, static_cast<int>(n));
  std::set<int> all;
  for (const auto& [thing, labels] : LabelsOf(truth, result)) {
    EXPECT_EQ(labels.size(), 1u) << "thing " << thing;
    EXPECT_FALSE(labels.contains(0)) << "thing " << thing;
    all.insert(labels.begin(), labels.end());
  }
  EXPECT_EQ(all.size(), n);
}

TEST(SegmentFast, SeparatesBoxesThatTouch) {
  ExpectOneObjectEach(
      TableWith({At(-0.06, 0.70, 0, 0.12, 0.08, 0.16), At(0.06, 0.68, 0, 0.12, 0.14, 0.07)}));
}

TEST(SegmentFast, SeparatesBoxesOnTopOfEachOther) {
  ExpectOneObjectEach(
      TableWith({At(0, 0.70, 0, 0.26, 0.18, 0.07), At(0.02, 0.72, 0.07, 0.14, 0.10, 0.06),
                 At(0.01, 0.73, 0.13, 0.07, 0.06, 0.08)}));
}

TEST(SegmentFast, JoinsABoxThatAnotherCutsInTwo) {
  ExpectOneObjectEach(
      TableWith({At(0, 0.85, 0, 0.30, 0.08, 0.12), At(0, 0.65, 0, 0.06, 0.06, 0.24)}));
}

TEST(SegmentFast, KeepsTwoBoxesApartWhoseEndsShowBesideWhatIsInFront) {
  ExpectOneObjectEach(
      TableWith({At(-0.12, 0.85, 0, 0.10, 0.08, 0.12), At(0.12, 0.85, 0, 0.10, 0.08, 0.12),
                 At(0, 0.65, 0, 0.05, 0.06, 0.24)}));
}

TEST(SegmentFast, JoinsTheInsideOfACupToItsWall) {
  ExpectOneObjectEach(TableWith({}, {{{-0.12, 0.65}, 0.04, 0.09}, {{0.05, 0.70}, 0.09, 0.08}}));
}

TEST(SegmentFast, KeepsApartACupAndTheBoxBehindIt) {
  ExpectOneObjectEach(TableWith({At(0.02, 0.72, 0, 0.16, 0.08, 0.15)}, {{{0, 0.60}, 0.045, 0.10}}));
}

TEST(SegmentFast, KeepsOrDropsFlatThingsAsConfigured) {
  const BoxWorld world = TableWith({At(-0.05, 0.55, 0, 0.10, 0.08, 0.006)});
  SegmentationConfig config;
  config.min_height_m = 0.004;
  ExpectOneObjectEach(world, config);
  config.min_height_m = 0.01;
  EXPECT_EQ(SegmentFast(world.Render(), config).n_objects, 0);
}

TEST(SegmentFast, FindsTheSameAtAnyResolution) {
  for (const auto& [width, height] :
       {std::pair(320, 240), std::pair(640, 480), std::pair(1280, 720), std::pair(1280, 960)}) {
    BoxWorld world = ThreeBoxes();
    world.width = width;
    world.height = height;
    world.noise_m = kKinectNoise_m;
    SCOPED_TRACE(width);
    ExpectOneObjectEach(world);
  }
}

TEST(SegmentFast, TakesTheTableAndNotASecondOneBesideIt) {
  BoxWorld world = ThreeBoxes();
  world.boxes.push_back({{0.62, 0.3, -0.3}, {1.4, 1.3, -0.12}});
  world.noise_m = kKinectNoise_m;
  const Segmentation result = SegmentFast(world.Render(), {});
  ASSERT_TRUE(result.table_C) << result.reason;
  EXPECT_NEAR(result.table_C->offset_m, world.camera_height_m, 0.005);
  EXPECT_EQ(result.n_objects, 3);
}

TEST(SegmentFast, WhatIsBesideTheTableIsNoObject) {
  BoxWorld world = ThreeBoxes();
  world.boxes[0] = {{-0.3, 0.45, -0.03}, {0.3, 1.05, 0}};
  world.boxes.push_back({{-3, -1, -0.75}, {3, 4, -0.72}});          // the floor
  world.boxes.push_back({{0.45, 0.6, -0.72}, {0.85, 1.0, 0.2}});    // a chair
  world.boxes.push_back({{-0.2, 0.25, -0.1}, {0.2, 0.36, -0.08}});  // a tray before it
  world.noise_m = kKinectNoise_m;
  const Segmentation result = SegmentFast(world.Render(), {});
  ASSERT_TRUE(result.table_C) << result.reason;
  EXPECT_EQ(result.n_objects, 3);
}

TEST(SegmentFast, SurvivesClutterOnMostOfTheTable) {
  BoxWorld world = TableWith({});
  std::mt19937 engine(3);
  auto uniform = [&engine](double low, double high) {
    return low + (high - low) * static_cast<double>(engine() % 1000) / 1000;
  };
  for (int i = 0; i < 60; ++i) {
    world.boxes.push_back(At(uniform(-0.4, 0.4), uniform(0.5, 1.1), 0, uniform(0.03, 0.12),
                             uniform(0.03, 0.12), uniform(0.03, 0.2)));
  }
  const Segmentation result = SegmentFast(world.Render(), {});
  ASSERT_TRUE(result.table_C) << result.reason;
  EXPECT_NEAR(result.table_C->offset_m, world.camera_height_m, 0.006);
  EXPECT_GT(result.n_objects, 10);
}

TEST(SegmentFast, ATiltedCameraIsNoMatter) {
  for (double pitch_deg : {20.0, 38.0, 60.0, 75.0}) {
    BoxWorld world = TableWith({});
    world.pitch_deg = pitch_deg;
    world.camera_height_m = pitch_deg > 50 ? 0.9 : 0.5;
    const double y = pitch_deg > 50 ? 0.45 : 0.8;
    world.boxes[0] = {{-0.6, 0.0, -0.03}, {0.6, 1.3, 0}};
    world.boxes.push_back(At(0, y, 0, 0.1, 0.1, 0.12));
    SCOPED_TRACE(pitch_deg);
    ExpectOneObjectEach(world);
  }
}

}  // namespace
}  // namespace beckon::perception
