// Images from files and folders.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "services/base/cloud_file.h"
#include "services/capture/file_source.h"
#include "services/capture/source_choice.h"

namespace beckon::capture {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class SourceTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("source_test_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// A cloud of one point `z` metres before the camera.
  std::string PutCloud(const std::string& name, float z) {
    Cloud cloud;
    cloud.width = 1;
    cloud.points = {{0, 0, z}};
    EXPECT_TRUE(WritePcdFile((folder_ / name).string(), cloud).ok());
    return (folder_ / name).string();
  }

  fs::path folder_;
};

TEST(NaturalOrderTest, NumbersCountAsNumbers) {
  EXPECT_TRUE(NaturallyBefore("learn2.pcd", "learn10.pcd"));
  EXPECT_FALSE(NaturallyBefore("learn10.pcd", "learn2.pcd"));
  EXPECT_TRUE(NaturallyBefore("a", "ab"));
  EXPECT_TRUE(NaturallyBefore("a1b2", "a1b10"));
  EXPECT_TRUE(NaturallyBefore("x007", "x10"));
  EXPECT_FALSE(NaturallyBefore("same3", "same3"));
  EXPECT_NE(NaturallyBefore("a01", "a1"), NaturallyBefore("a1", "a01"));
}

TEST_F(SourceTest, AFolderIsShownInOrderAndOverAgain) {
  PutCloud("c10.pcd", 3);
  PutCloud("c2.pcd", 2);
  PutCloud("c1.pcd", 1);
  std::ofstream(folder_ / "c3.pcd") << "garbled";
  std::ofstream(folder_ / "notes.txt") << "not a cloud";
  Options options;
  options.input = folder_.string();
  auto source = OpenSource(options);
  ASSERT_TRUE(source.ok()) << source.error().message;
  std::string names;
  for (int i = 0; i < 4; ++i) {
    auto next = (*source)->Next();
    ASSERT_TRUE(next.ok() && next->has_value());
    names += (*next)->name + " ";
  }
  EXPECT_EQ(names, "c1.pcd c2.pcd c10.pcd c1.pcd ");
}

TEST_F(SourceTest, AFolderShownOnceEnds) {
  PutCloud("a.pcd", 1);
  PutCloud("b.pcd", 2);
  std::ofstream(folder_ / "c.pcd") << "garbled";
  Options options;
  options.input = folder_.string();
  options.once = true;
  auto source = OpenSource(options);
  ASSERT_TRUE(source.ok());
  EXPECT_TRUE((*source)->Next()->has_value());
  EXPECT_TRUE((*source)->Next()->has_value());
  const auto end = (*source)->Next();
  ASSERT_TRUE(end.ok());
  EXPECT_FALSE(end->has_value());
}

TEST_F(SourceTest, AStillImageIsTheSameForEver) {
  Options options;
  options.input = PutCloud("a.pcd", 1);
  auto source = OpenSource(options);
  ASSERT_TRUE(source.ok());
  const auto first = (*source)->Next(), second = (*source)->Next();
  EXPECT_EQ((*first)->image, (*second)->image);
  EXPECT_EQ((*first)->name, "a.pcd");
}

TEST_F(SourceTest, RefusesAFolderWithoutAnImage) {
  Options options;
  options.input = folder_.string();
  EXPECT_THAT(OpenSource(options).error().message, HasSubstr("found none"));
  std::ofstream(folder_ / "a.pcd") << "garbled";
  EXPECT_THAT(OpenSource(options).error().message, HasSubstr("a.pcd"));
}

}  // namespace
}  // namespace beckon::capture
