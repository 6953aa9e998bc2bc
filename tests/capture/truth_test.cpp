// Ground truth: written and read again, and found for what a file shows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "services/base/cloud_file.h"
#include "services/base/scene_truth.h"
#include "services/capture/description_json.h"
#include "services/capture/frame_set_writer.h"
#include "services/capture/image_files.h"
#include "services/capture/object_set_writer.h"
#include "services/capture/source_choice.h"

namespace beckon::capture {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class TruthTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("truth_test_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string Path(const std::string& name) const { return (folder_ / name).string(); }

  fs::path folder_;
};

TEST_F(TruthTest, RenderedFramesAreReadAgain) {
  ASSERT_TRUE(WriteFrameSet(folder_.string(), 9, 2).ok());
  for (const char* name :
       {"0000.pcd", "0001_rgb.png", "0001_depth.png", "0001_labels.png", "0001_truth.json"}) {
    EXPECT_TRUE(fs::exists(folder_ / name)) << name;
  }
  const auto cloud = ReadCloudFile(Path("0001.pcd"));
  ASSERT_TRUE(cloud.ok()) << cloud.error().message;
  EXPECT_EQ(cloud->width, 640);
  EXPECT_EQ(cloud->labels.size(), cloud->points.size());
  EXPECT_NEAR(EstimateIntrinsics(*cloud)->fx, 525, 0.1);
  Options options;
  options.input = Path("0001.pcd");
  const auto description = DescribeInput(options);
  ASSERT_TRUE(description.ok()) << description.error().message;
  ASSERT_TRUE(description->known);
  for (const auto& object : description->objects) {
    EXPECT_EQ(object.visible_points,
              std::count(cloud->labels.begin(), cloud->labels.end(), uint32_t(object.label)));
  }
  const auto truth = ReadSceneTruth(Path("0001_truth.json"));
  ASSERT_TRUE(truth.ok()) << truth.error().message;
  EXPECT_EQ(truth->objects.size(), description->objects.size());
}

TEST_F(TruthTest, JsonHoldsEverything) {
  SceneDescription d;
  d.known = true;
  d.table_C = Plane{{0, -0.6, -0.8}, 0.7};
  d.intrinsics = {500, 510, 300, 200};
  DescribedObject object{.label = 3, .category = "Mug", .centroid_C = {0.1, 0.2, 0.9}};
  object.box_C = {Eigen::Vector3d(0, 0.1, 0.8), Eigen::Vector3d(0.2, 0.3, 1)};
  object.X_CO = Pose(Eigen::Translation3d(1, 2, 3));
  d.objects.push_back(object);
  ASSERT_TRUE(WriteText(Path("a.json"), ToJson(d)).ok());
  const auto again = ReadDescription(Path("a.json"));
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(ToJson(*again), ToJson(d));
  EXPECT_EQ(again->objects[0].category, "Mug");
  EXPECT_FALSE(again->objects[0].X_WO);
  for (const char* text : {"", "{}", "[1, 2", R"({"table": 3, "intrinsics": {}, "objects": []})"}) {
    ASSERT_TRUE(WriteText(Path("b.json"), text).ok());
    const auto bad = ReadDescription(Path("b.json"));
    ASSERT_FALSE(bad.ok());
    EXPECT_THAT(bad.error().message, HasSubstr("b.json"));
  }
}

TEST_F(TruthTest, LabelledCloudsHaveTheirCategoriesBesideThem) {
  Cloud cloud;
  const Intrinsics camera;
  for (int i = 0; i < 30; ++i) {
    cloud.points.push_back(camera.Unproject(300 + i, 200, 0.8).cast<float>());
    cloud.labels.push_back(i < 10 ? 5 : i < 20 ? 21 : 35);
  }
  cloud.width = 30;
  ASSERT_TRUE(WritePcdFile(Path("scene.pcd"), cloud).ok());
  Options options;
  options.input = Path("scene.pcd");
  EXPECT_FALSE(DescribeInput(options)->known) << "no categories yet";
  EXPECT_THAT(ToJson(*DescribeInput(options)), HasSubstr("\"objects\": null"));
  ASSERT_TRUE(WriteText(Path("categories.json"), R"({"scene": {"2": "Box", "3": "Tin"}})").ok());
  const auto description = DescribeInput(options);
  ASSERT_TRUE(description.ok()) << description.error().message;
  ASSERT_EQ(description->objects.size(), 2u);
  EXPECT_EQ(description->objects[0].label, 2);
  EXPECT_EQ(description->objects[0].category, "Box");
  EXPECT_EQ(description->objects[0].visible_points, 10);
  EXPECT_NEAR(description->objects[1].centroid_C.z(), 0.8, 1e-6);
  ASSERT_TRUE(WriteText(Path("categories.json"), R"({"scene": {"two": "Box"}})").ok());
  EXPECT_THAT(DescribeInput(options).error().message, HasSubstr("categories.json"));
}

TEST_F(TruthTest, ObjectSetsAreWrittenAlikeForTheSameSeed) {
  const std::string a = Path("a"), b = Path("b");
  ASSERT_TRUE(WriteObjectSet(a, {3, 1}).ok());
  ASSERT_TRUE(WriteObjectSet(b, {3, 1}).ok());
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(a)) {
    if (!entry.is_regular_file()) continue;
    const auto bytes = [](const fs::path& path) {
      std::ifstream file(path, std::ios::binary);
      return std::string(std::istreambuf_iterator<char>(file), {});
    };
    EXPECT_EQ(bytes(entry.path()), bytes(b / fs::relative(entry.path(), a))) << entry.path();
    ++files;
  }
  EXPECT_EQ(files, (11 + 2) * 2 * 4 + 1);  // two of no category
  const auto mug = ReadCloudFile(a + "/Mug/Mug_0000_view1.pcd");
  ASSERT_TRUE(mug.ok());
  EXPECT_FALSE(mug->organised());
  EXPECT_EQ(mug->colours.size(), mug->points.size());
}

}  // namespace
}  // namespace beckon::capture
