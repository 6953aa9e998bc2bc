// Segmentation of worlds whose truth is known.
#include "services/perception/segmentation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "tests/perception/box_world.h"

namespace beckon::perception {
namespace {

constexpr double kDegree = 3.14159265358979 / 180;

/// Where objects begin, above the table: the reference leaves out what is lower than min_height_m,
/// fast takes objects down to the table.
double FootOf(SegmentationMethod method) {
  return method == SegmentationMethod::kReference ? SegmentationConfig().min_height_m : -1;
}

/// Intersection over union of a label with a box of the world, of which the truth is what is higher
/// than `foot_m` above the table.
double BestOverlap(const BoxWorld& world, const RgbdImage& image,
                   const std::vector<int>& box_of_pixel, int box, double foot_m,
                   const Segmentation& segmentation) {
  const Pose X_WC = world.X_WC();
  double best = 0;
  for (int label = 1; label <= segmentation.n_objects; ++label) {
    int both = 0, either = 0;
    for (int v = 0; v < image.height; ++v) {
      for (int u = 0; u < image.width; ++u) {
        const size_t i = image.Index(u, v);
        const bool truth = box_of_pixel[i] == box && (X_WC * image.Point(u, v)).z() > foot_m;
        const bool found = segmentation.labels[i] == label;
        both += truth && found;
        either += truth || found;
      }
    }
    best = std::max(best, static_cast<double>(both) / either);
  }
  return best;
}

void ExpectTable(const BoxWorld& world, const Segmentation& segmentation) {
  ASSERT_TRUE(segmentation.table_C) << segmentation.reason;
  const Eigen::Vector3d up_C = world.X_WC().linear().transpose() * Eigen::Vector3d::UnitZ();
  EXPECT_LT(std::acos(std::min(1.0, segmentation.table_C->normal.dot(up_C))), 1 * kDegree);
  EXPECT_NEAR(segmentation.table_C->offset_m, world.camera_height_m, 0.005);
  EXPECT_NEAR(segmentation.table_C->normal.norm(), 1, 1e-6);
  EXPECT_GE(segmentation.hull_C.size(), 3u);
  for (const auto& p : segmentation.hull_C) EXPECT_NEAR(segmentation.table_C->Distance(p), 0, 1e-6);
}

/// What holds whatever the method.
class SegmentationTest : public testing::TestWithParam<SegmentationMethod> {
 protected:
  SegmentationTest() { config_.method = GetParam(); }
  SegmentationConfig config_;
  const double foot_m_ = FootOf(GetParam());
};

INSTANTIATE_TEST_SUITE_P(Methods, SegmentationTest,
                         testing::Values(SegmentationMethod::kFast, SegmentationMethod::kReference),
                         [](const auto& method) { return std::string(Name(method.param)); });

TEST_P(SegmentationTest, FindsTheTableAndEveryObjectOnIt) {
  const BoxWorld world = ThreeBoxes();
  std::vector<int> truth;
  const RgbdImage image = world.Render(&truth);
  const Segmentation result = Segment(image, config_);
  ExpectTable(world, result);
  ASSERT_EQ(result.n_objects, 3);
  for (int box = 2; box <= 4; ++box) {
    EXPECT_GT(BestOverlap(world, image, truth, box, foot_m_, result), 0.93) << "box " << box;
  }
}

TEST_P(SegmentationTest, BearsTheNoiseOfADepthCamera) {
  BoxWorld world = ThreeBoxes();
  world.noise_m = 0.002;
  std::vector<int> truth;
  const RgbdImage image = world.Render(&truth);
  const Segmentation result = Segment(image, config_);
  ExpectTable(world, result);
  EXPECT_EQ(result.n_objects, 3);
  for (int box = 2; box <= 4; ++box) {
    EXPECT_GT(BestOverlap(world, image, truth, box, foot_m_, result), 0.85) << "box " << box;
  }
}

TEST_P(SegmentationTest, NumbersTheLargestObjectFirst) {
  const Segmentation result = Segment(ThreeBoxes().Render(), config_);
  std::vector<int> pixels(4, 0);
  for (uint16_t label : result.labels) ++pixels.at(label);
  EXPECT_GE(pixels[1], pixels[2]);
  EXPECT_GE(pixels[2], pixels[3]);
}

TEST_P(SegmentationTest, IsTheSameToTheByteEveryTime) {
  BoxWorld world = ThreeBoxes();
  world.noise_m = 0.003;
  const RgbdImage image = world.Render();
  const Segmentation first = Segment(image, config_);
  for (int i = 0; i < 3; ++i) {
    const Segmentation again = Segment(image, config_);
    EXPECT_EQ(again.labels, first.labels);
    EXPECT_EQ(again.table_C->normal, first.table_C->normal);
    EXPECT_EQ(again.table_C->offset_m, first.table_C->offset_m);
    EXPECT_EQ(again.hull_C, first.hull_C);
  }
}

TEST_P(SegmentationTest, AnEmptyTableHasNoObjects) {
  BoxWorld world;
  world.boxes = {Table()};
  const Segmentation result = Segment(world.Render(), config_);
  ExpectTable(world, result);
  EXPECT_EQ(result.n_objects, 0);
}

TEST_P(SegmentationTest, AWallIsNoTable) {
  BoxWorld world;
  world.pitch_deg = 10;
  world.boxes = {{{-3, 1.5, -1}, {3, 1.6, 3}}};
  const Segmentation result = Segment(world.Render(), config_);
  EXPECT_FALSE(result.table_C);
  EXPECT_EQ(result.n_objects, 0);
  EXPECT_THAT(result.reason, testing::HasSubstr("tilted"));
}

TEST_P(SegmentationTest, TakesTheTableWhereTheWallBehindItIsLarger) {
  BoxWorld world = ThreeBoxes();
  world.pitch_deg = 25;
  world.boxes[0] = {{-0.3, 0.45, -0.03}, {0.3, 1.05, 0}};
  world.boxes.push_back({{-3, 1.6, -1}, {3, 1.7, 3}});
  std::vector<int> truth;
  world.Render(&truth);
  ASSERT_GT(std::count(truth.begin(), truth.end(), 5), std::count(truth.begin(), truth.end(), 1));
  const Segmentation result = Segment(world.Render(), config_);
  ExpectTable(world, result);
  EXPECT_EQ(result.n_objects, 3);
}

TEST_P(SegmentationTest, TakesTheTableAndNotTheFloor) {
  BoxWorld world = ThreeBoxes();
  world.boxes[0] = {{-0.3, 0.45, -0.03}, {0.3, 1.05, 0}};
  world.boxes.push_back({{-3, -1, -0.75}, {3, 4, -0.72}});
  const Segmentation result = Segment(world.Render(), config_);
  ExpectTable(world, result);
  EXPECT_EQ(result.n_objects, 3);
}

TEST_P(SegmentationTest, AWallThatTheTableTouchesIsNoObject) {
  BoxWorld world = ThreeBoxes();
  world.pitch_deg = 25;
  world.boxes.push_back({{-3, 1.3, -1}, {3, 1.4, 3}});
  world.noise_m = 0.002;
  const Segmentation result = Segment(world.Render(), config_);
  ExpectTable(world, result);
  EXPECT_EQ(result.n_objects, 3);
}

TEST_P(SegmentationTest, WithoutDepthSaysSo) {
  RgbdImage image = ThreeBoxes().Render();
  image.depth_m.assign(image.depth_m.size(), 0);
  const Segmentation result = Segment(image, config_);
  EXPECT_FALSE(result.table_C);
  EXPECT_THAT(result.reason, testing::HasSubstr("only 0 pixels"));
  EXPECT_EQ(result.labels.size(), image.depth_m.size());
}

TEST_P(SegmentationTest, IgnoresDepthThatIsNoNumberOrOutOfRange) {
  const BoxWorld world = ThreeBoxes();
  RgbdImage image = world.Render();
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(),
                       std::numeric_limits<float>::infinity(),
                       -std::numeric_limits<float>::infinity(), -1, 1e30f};
  for (size_t i = 0; i < image.depth_m.size(); i += 7) image.depth_m[i] = bad[i % 5];
  const Segmentation result = Segment(image, config_);
  ExpectTable(world, result);
  EXPECT_EQ(result.n_objects, 3);
  for (size_t i = 0; i < image.depth_m.size(); i += 7) EXPECT_EQ(result.labels[i], 0);
}

TEST_P(SegmentationTest, TinyAndEmptyImagesHaveNoTable) {
  for (int size : {0, 1, 2, 16}) {
    BoxWorld world = ThreeBoxes();
    world.width = world.height = size;
    const Segmentation result = Segment(world.Render(), config_);
    EXPECT_FALSE(result.table_C);
    EXPECT_FALSE(result.reason.empty());
    EXPECT_EQ(result.labels.size(), static_cast<size_t>(size) * size);
  }
}

TEST_P(SegmentationTest, PointsOnALineAreNoTable) {
  RgbdImage image = ThreeBoxes().Render();
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      if (v != 120) image.depth_m[image.Index(u, v)] = 0;
    }
  }
  SegmentationConfig config = config_;
  config.plane_min_points = 10;
  const Segmentation result = Segment(image, config);  // must not hang or crash
  EXPECT_EQ(result.n_objects, 0);
}

TEST_P(SegmentationTest, KeepsTheLargestWhereThereAreTooMany) {
  SegmentationConfig config = config_;
  config.max_objects = 2;
  const Segmentation result = Segment(ThreeBoxes().Render(), config);
  EXPECT_EQ(result.n_objects, 2);
  EXPECT_EQ(result.n_left_out, 1);
  EXPECT_EQ(*std::max_element(result.labels.begin(), result.labels.end()), 2);
}

TEST(SegmentReference, MayUseNormals) {
  BoxWorld world = ThreeBoxes();
  world.width = 160;
  world.height = 120;
  SegmentationConfig config;
  config.method = SegmentationMethod::kReference;
  config.use_normals = true;
  config.cluster_min_points = 50;
  std::set<std::string> steps;
  const Segmentation result =
      Segment(world.Render(), config, [&steps](const StepDone& step) { steps.insert(step.name); });
  ExpectTable(world, result);
  EXPECT_EQ(result.n_objects, 3);
  EXPECT_THAT(steps, testing::ElementsAre("clusters", "hull", "labels", "normals", "plane", "prism",
                                          "range_voxels"));
}

TEST(SegmentationMethod, HasNamesThatParse) {
  for (const auto method : {SegmentationMethod::kFast, SegmentationMethod::kReference}) {
    EXPECT_EQ(*ParseSegmentationMethod(Name(method)), method);
  }
  const auto unknown = ParseSegmentationMethod("magic");
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message, testing::HasSubstr("'magic'"));
}

}  // namespace
}  // namespace beckon::perception
