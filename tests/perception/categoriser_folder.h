// A folder of little views for the tests of training.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "services/base/cloud_file.h"
#include "services/perception/train_program.h"
#include "tests/perception/categoriser_trained.h"

namespace beckon::perception {

namespace fs = std::filesystem;

/// A folder of views that is removed afterwards.
class TrainFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(testing::TempDir()) /
        (std::string("beckon_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void Write(const std::string& file, const std::string& category, uint32_t seed,
             bool coloured = true) {
    std::mt19937 random(seed);
    const ShapeView view = RenderCategory(category, random);
    Cloud cloud;
    for (const uint32_t pixel : view.pixels) {
      const int u = static_cast<int>(pixel) % view.image.width;
      const int v = static_cast<int>(pixel) / view.image.width;
      cloud.points.push_back(view.image.Point(u, v).cast<float>());
      cloud.colours.push_back(view.image.colour[pixel]);
    }
    if (!coloured) cloud.colours.clear();
    cloud.width = static_cast<int>(cloud.points.size());
    const fs::path path = folder_ / file;
    fs::create_directories(path.parent_path());
    ASSERT_TRUE(WritePcdFile(path.string(), cloud));
  }

  /// `instances` of each of Bowl, Box and Can, one view each.
  void WriteAll(uint32_t instances) {
    for (uint32_t i = 0; i < instances; ++i) {
      for (const std::string category : {"Bowl", "Box", "Can"}) {
        Write(category + "/" + std::to_string(i) + "_0.pcd", category, 10 + i);
      }
    }
  }

  std::string Path(const std::string& file) const { return (folder_ / file).string(); }
  std::string Read(const std::string& file) const {
    std::ifstream in(folder_ / file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  TrainOptions Options() const {
    TrainOptions options;
    options.data = folder_.string();
    options.model = Path("m.model");
    return options;
  }

  fs::path folder_;
};

}  // namespace beckon::perception
