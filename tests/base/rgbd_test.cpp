// Clouds as images: the camera is found again, points land on their pixels.
#include "services/base/rgbd.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "services/base/cloud_file.h"

namespace beckon {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A bumpy surface seen by a camera, every seventh pixel without depth.
Cloud Organised(int width, int height, const Intrinsics& camera) {
  Cloud cloud;
  cloud.width = width;
  cloud.height = height;
  std::mt19937 random(1);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double z = 0.8 + 0.001 * static_cast<double>(random() % 100);
      Eigen::Vector3f p = camera.Unproject(u, v, z).cast<float>();
      if ((u + v) % 7 == 0) p.setConstant(kNan);
      cloud.points.push_back(p);
      cloud.colours.push_back({uint8_t(u), uint8_t(v), 0});
      cloud.labels.push_back(uint32_t(u));
    }
  }
  return cloud;
}

std::string DataFolder() {
  if (const char* folder = std::getenv("BECKON_DATA")) return folder;
  return std::string(BECKON_SOURCE_DIR) + "/../shared/data";
}

TEST(EstimateIntrinsicsTest, FindsTheCamera) {
  const Intrinsics camera{310, 290, 81.5, 55};
  const auto found = EstimateIntrinsics(Organised(160, 120, camera));
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_NEAR(found->fx, 310, 0.01);
  EXPECT_NEAR(found->fy, 290, 0.01);
  EXPECT_NEAR(found->cx, 81.5, 0.01);
  EXPECT_NEAR(found->cy, 55, 0.01);
}

TEST(EstimateIntrinsicsTest, RefusesWhatNoCameraTook) {
  Cloud cloud = Organised(160, 120, {});
  std::mt19937 random(2);
  for (auto& p : cloud.points)
    p = Eigen::Vector3f(random() % 100, random() % 100, 100 + random() % 100) * 0.01f;
  EXPECT_FALSE(EstimateIntrinsics(cloud).ok());
  Cloud few = Organised(9, 9, {});
  EXPECT_FALSE(EstimateIntrinsics(few).ok());
  Cloud list = Organised(160, 120, {});
  list.width *= list.height, list.height = 1;
  EXPECT_FALSE(EstimateIntrinsics(list).ok());
  Cloud same = Organised(160, 120, {});
  for (auto& p : same.points) p = {0.1f, 0.1f, 1};
  EXPECT_FALSE(EstimateIntrinsics(same).ok());
}

TEST(ToImageTest, KeepsTheGridOfAnOrganisedCloud) {
  const Intrinsics camera{310, 290, 81.5, 55};
  const Cloud cloud = Organised(160, 120, camera);
  std::vector<uint32_t> labels;
  const auto image = ToImage(cloud, nullptr, &labels);
  ASSERT_TRUE(image.ok()) << image.error().message;
  EXPECT_EQ(image->width, 160);
  EXPECT_NEAR(image->intrinsics.fx, 310, 0.01);
  EXPECT_EQ(labels, cloud.labels);
  EXPECT_EQ(image->colour, cloud.colours);
  for (size_t i = 0; i < cloud.points.size(); ++i) {
    EXPECT_EQ(image->depth_m[i], std::isnan(cloud.points[i].z()) ? 0.0f : cloud.points[i].z());
  }
  EXPECT_NEAR((image->Point(30, 20).cast<float>() - cloud.points[20 * 160 + 30]).norm(), 0, 1e-4);
  const Intrinsics told{300, 300, 80, 60};
  EXPECT_EQ(ToImage(cloud, &told)->intrinsics.fx, 300);
}

TEST(ToImageTest, ProjectsAnUnorganisedCloudNearestFirst) {
  Cloud cloud;
  const Intrinsics camera;
  for (double z : {1.0, 0.7, 0.9})
    cloud.points.push_back(camera.Unproject(100, 50, z).cast<float>());
  cloud.points.push_back(camera.Unproject(639, 479, 2).cast<float>());
  cloud.points.push_back(camera.Unproject(5000, 50, 1).cast<float>());
  cloud.points.emplace_back(0, 0, -1);
  cloud.points.emplace_back(kNan, 0, 1);
  cloud.width = static_cast<int>(cloud.points.size());
  cloud.labels = {1, 2, 3, 4, 5, 6, 7};
  std::vector<uint32_t> labels;
  const auto image = ToImage(cloud, nullptr, &labels);
  ASSERT_TRUE(image.ok());
  EXPECT_EQ(image->width, 640);
  EXPECT_EQ(image->height, 480);
  EXPECT_FLOAT_EQ(image->depth_m[image->Index(100, 50)], 0.7f);
  EXPECT_EQ(labels[image->Index(100, 50)], 2u);
  EXPECT_EQ(labels[image->Index(639, 479)], 4u);
  EXPECT_EQ(
      std::count_if(image->depth_m.begin(), image->depth_m.end(), [](float z) { return z > 0; }),
      2);
  EXPECT_TRUE(image->colour.empty());
}

TEST(ToImageTest, RefusesWhatNothingCanBeSeenOf) {
  Cloud cloud;
  EXPECT_FALSE(ToImage(cloud).ok());
  cloud.points = {{0, 0, -1}, {kNan, kNan, kNan}};
  cloud.width = 2;
  EXPECT_FALSE(ToImage(cloud).ok());
  cloud.points = {{0, 0, 1}};
  EXPECT_FALSE(ToImage(cloud).ok()) << "two points told, one there";
  cloud.width = 1;
  EXPECT_TRUE(ToImage(cloud).ok());
  const Intrinsics wrong{0, 525, 320, 240};
  EXPECT_FALSE(ToImage(cloud, &wrong).ok());
}

TEST(RealCloudsTest, AreReadWithTheirCamera) {
  const std::string folder = DataFolder();
  if (!std::filesystem::exists(folder + "/osd"))
    GTEST_SKIP() << folder << " is absent: set BECKON_DATA";
  for (const char* name : {"learn0", "learn20", "learn44"}) {
    const auto cloud = ReadCloudFile(folder + "/osd/" + name + ".pcd");
    ASSERT_TRUE(cloud.ok()) << cloud.error().message;
    EXPECT_EQ(cloud->width, 640);
    EXPECT_EQ(cloud->labels.size(), cloud->points.size());
    const auto camera = EstimateIntrinsics(*cloud);
    ASSERT_TRUE(camera.ok()) << camera.error().message;
    EXPECT_NEAR(camera->fx, 525, 0.5);
    EXPECT_NEAR(camera->fy, 525, 0.5);
    EXPECT_NEAR(camera->cx, 319.5, 0.5);
    EXPECT_NEAR(camera->cy, 239.5, 0.5);
  }
  const auto lab = ReadCloudFile(folder + "/lab/table_capture_1.ply");
  ASSERT_TRUE(lab.ok()) << lab.error().message;
  EXPECT_EQ(lab->points.size(), 83576u);
  EXPECT_EQ(lab->colours.size(), 83576u);
  EXPECT_TRUE(ToImage(*lab).ok());
}

}  // namespace
}  // namespace beckon
