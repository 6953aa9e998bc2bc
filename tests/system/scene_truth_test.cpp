// Ground truth files, right and wrong.
#include "services/base/scene_truth.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace beckon {
namespace {

Result<SceneTruth> Read(const std::string& json) {
  const std::string path =
      ::testing::TempDir() + std::to_string(getpid()) + "_scene_truth_test.json";
  std::ofstream(path) << json;
  auto truth = ReadSceneTruth(path);
  std::filesystem::remove(path);
  return truth;
}

TEST(SceneTruth, ReadsObjectsAndLeavesOtherKeysAlone) {
  const auto truth =
      Read(R"({"seed": 1, "objects": [{"category": "Box", "centroid_C": [1, 2.5, 3], "id": 4}]})");
  ASSERT_TRUE(truth);
  EXPECT_TRUE(truth->known);
  ASSERT_EQ(truth->objects.size(), 1u);
  EXPECT_EQ(truth->objects[0].category, "Box");
  EXPECT_EQ(truth->objects[0].centroid_C, Eigen::Vector3d(1, 2.5, 3));
}

TEST(SceneTruth, NullMeansThatNobodyKnows) {
  const auto truth = Read(R"({"objects": null})");
  ASSERT_TRUE(truth);
  EXPECT_FALSE(truth->known);
}

TEST(SceneTruth, RefusesWhatIsNoTruth) {
  for (const char* json : {"", "[]", "{}", "{", R"({"objects": 3})", R"({"objects": [3]})",
                           R"({"objects": [{"category": "Box"}]})",
                           R"({"objects": [{"category": "Box", "centroid_C": [1, 2]}]})",
                           R"({"objects": [{"category": "Box", "centroid_C": [1, 2, "3"]}]})",
                           R"({"objects": [{"category": "Box", "centroid_C": [1, 2, 1e999]}]})",
                           R"({"objects": [{"category": 1, "centroid_C": [1, 2, 3]}]})"}) {
    EXPECT_FALSE(Read(json)) << json;
  }
  EXPECT_FALSE(ReadSceneTruth("/nowhere/truth.json"));
}

TEST(SceneTruth, FindsWhatASegmentShowsAndTheFirstInstance) {
  SceneTruth truth{true,
                   {{"Box", {0, 0, 2}, {}}, {"Box", {0.1, 0, 1}, {}}, {"Cup", {0, 0, 0.5}, {}}}};
  EXPECT_EQ(truth.At({0, 0, 1.97}), 0u);
  EXPECT_FALSE(truth.At({0, 0, 1.5}));
  Pose X_WC = Pose::Identity();  // W's y along the camera's z
  X_WC.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  EXPECT_EQ(truth.FirstInstance("Box", X_WC), 1u);
  EXPECT_FALSE(truth.FirstInstance("Tub", X_WC));
}

TEST(SceneTruth, APartOfAnOccludedObjectIsThatObject) {
  // A tube behind a box: both ends of the tube are seen, its middle is not.
  const auto truth = Read(R"({"objects": [
      {"category": "Box", "centroid_C": [0, 0, 0.67], "box_C": {"min": [-0.04, -0.1, 0.64], "max": [0.04, 0.1, 0.7]}},
      {"category": "Tube", "centroid_C": [0, 0, 0.76], "box_C": {"min": [-0.14, -0.03, 0.73], "max": [0.14, 0.03, 0.79]}}
  ]})");
  ASSERT_TRUE(truth) << truth.error().message;
  EXPECT_EQ(truth->At({-0.09, 0, 0.76}), 1u);
  EXPECT_EQ(truth->At({0.09, 0, 0.76}), 1u);
  EXPECT_EQ(truth->At({0, 0, 0.67}), 0u);
  EXPECT_FALSE(truth->At({0.3, 0, 0.76}));
}

}  // namespace
}  // namespace beckon
