// A labelled scene offline: a result an object, the same as over the bus; one clear line on bad
// labels.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "lcmtypes/codec.h"
#include "services/base/cloud_file.h"
#include "services/base/rim.h"
#include "services/pose/pose_files.h"
#include "services/pose/service.h"
#include "tests/pose/program.h"
#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class OfflineLabelsTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    WriteScene("scene.pcd", scene_.image);
    cv::Mat labels(240, 320, CV_16U);
    for (int i = 0; i < 320 * 240; ++i) {
      labels.at<uint16_t>(i / 320, i % 320) = kNames[scene_.labels[static_cast<size_t>(i)]];
    }
    cv::imwrite(Path("labels.png"), labels);
  }

  void WriteScene(const std::string& name, const RgbdImage& image) {
    Cloud cloud{
        .width = image.width, .height = image.height, .points = {}, .colours = {}, .labels = {}};
    for (int v = 0; v < image.height; ++v) {
      for (int u = 0; u < image.width; ++u) {
        cloud.points.push_back(
            image.HasDepth(u, v)
                ? Eigen::Vector3f(image.Point(u, v).cast<float>())
                : Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
      }
    }
    ASSERT_TRUE(WritePcdFile(Path(name), cloud));
  }

  std::string PlaneOption() const {
    const Plane& t = scene_.table_C;
    std::ostringstream text;
    text << " --plane " << t.normal.x() << ',' << t.normal.y() << ',' << t.normal.z() << ','
         << t.offset_m;
    return text.str();
  }

  /// The scene as perception tells it, through the codec, and what the service makes of it.
  msg::Poses OverTheBus() {
    msg::Scene scene{.utime = 1, .seq = 1, .frame_seq = 1, .source = "test"};
    scene.width = scene_.image.width;
    scene.height = scene_.image.height;
    scene.intrinsics = scene_.image.intrinsics;
    scene.has_table = true;
    scene.X_WC = WorldFromTable(scene_.table_C);
    const auto rims = FindRims(scene_.image, scene_.labels, 2, scene_.table_C);
    for (uint16_t k = 1; k <= 2; ++k) {
      msg::SceneObject& object = scene.objects.emplace_back();
      object.id = k;
      object.rim_C = rims[k - 1u];
      for (int i = 0; i < 320 * 240; ++i) {
        if (scene_.labels[static_cast<size_t>(i)] != k) continue;
        object.points_C.push_back(scene_.image.Point(i % 320, i / 320).cast<float>());
      }
    }
    const auto bytes = Codec<msg::Scene>::Encode(scene);
    EXPECT_TRUE(bytes) << bytes.error().message;
    const auto decoded = Codec<msg::Scene>::Decode(*bytes);
    EXPECT_TRUE(decoded) << decoded.error().message;
    return SceneEstimator{PoseConfig{}}.Estimate(*decoded);
  }

  static Eigen::Vector3d Position(const json& pose) {
    return Eigen::Vector3d(pose["position"].get<std::vector<double>>().data());
  }

  /// How far the bodies' tangent planes are apart in any of many directions, m; whatever their axes
  /// are called.
  static double LargestDifference(const json& pose_C, const Pose& X_WC,
                                  const msg::ObjectPose& pose_W) {
    const auto numbers = [&](const char* key) { return pose_C[key].get<std::vector<double>>(); };
    Superquadric offline, bus;
    offline.semi_axes = Eigen::Vector3d(numbers("semi_axes").data());
    offline.epsilon = Eigen::Vector2d(numbers("epsilon").data());
    const auto q = numbers("rotation");
    offline.X_FO.linear() =
        X_WC.linear() * Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
    bus.semi_axes = Eigen::Vector3d(pose_W.semi_axes.data());
    bus.epsilon = Eigen::Vector2d(pose_W.epsilon.data());
    bus.X_FO = pose_W.X_WO;
    const Eigen::Vector3d apart = X_WC * Position(pose_C) - pose_W.X_WO.translation();
    double largest_m = 0;
    for (const auto& direction : SampleSurface(Superquadric{}, 200)) {
      const Eigen::Vector3d n = direction.normalized();
      largest_m = std::max(
          largest_m, std::abs(HalfWidth(offline, n) - HalfWidth(bus, n)) + std::abs(apart.dot(n)));
    }
    return largest_m;
  }

  static constexpr uint16_t kNames[] = {0, 3, 700};  // labels as the file has them
  const TableScene scene_ =
      SceneOnTable({MakeShape({0.03, 0.04, 0.06}, 0.1, 0.1, {-0.08, 0, 0.06}, {0, 0, 0.5}),
                    MakeShape({0.035, 0.035, 0.05}, 0.1, 1, {0.08, 0.05, 0.05})},
                   0.0005);
};

TEST_F(OfflineLabelsTest, GivesTheSameBytesInEveryProcess) {
  ExpectSameBytesTwice("--input " + Path("scene.pcd") + " --labels " + Path("labels.png"));
}

TEST_F(OfflineLabelsTest, GiveAResultForEachObjectAsOverTheBus) {
  ASSERT_EQ(Run("--input " + Path("scene.pcd") + " --labels " + Path("labels.png") + PlaneOption() +
                " --json " + Path("out.json") + " --picture " + Path("out.png")),
            0)
      << error_;
  const json poses = json::parse(Read("out.json"));
  const msg::Poses bus = OverTheBus();
  ASSERT_EQ(poses.size(), 2u);
  ASSERT_EQ(bus.poses.size(), 2u);
  const Pose X_WC = WorldFromTable(scene_.table_C);
  for (size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(poses[k]["file"], Path("scene.pcd"));
    EXPECT_EQ(poses[k]["label"], kNames[k + 1]);
    EXPECT_EQ(poses[k]["converged"], bus.poses[k].converged) << poses[k]["reason"];
    // Points are rounded to 0.1 mm on the bus; what is hidden follows them at a distance.
    EXPECT_LT(LargestDifference(poses[k], X_WC, bus.poses[k]), 1e-3);
    EXPECT_LT((Position(poses[k]) - scene_.shapes_C[k].X_FO.translation()).norm(), 0.005);
    EXPECT_FALSE(poses[k]["grasps"].empty());
    EXPECT_FALSE(bus.poses[k].grasps.empty());
    EXPECT_TRUE(poses[k]["alternatives"].is_array());
    EXPECT_TRUE(poses[k]["parts"].is_array());
  }
  const cv::Mat picture = cv::imread(Path("out.png"));
  EXPECT_EQ(picture.size(), cv::Size(1280, 960)) << "not of the scene, enlarged";
}

TEST_F(OfflineLabelsTest, FindTheTableThemselves) {
  ASSERT_EQ(Run("--input " + Path("scene.pcd") + " --labels " + Path("labels.png") + " --json " +
                Path("out.json")),
            0)
      << error_;
  const json poses = json::parse(Read("out.json"));
  ASSERT_EQ(poses.size(), 2u);
  for (size_t k = 0; k < 2; ++k) {
    EXPECT_LT((Position(poses[k]) - scene_.shapes_C[k].X_FO.translation()).norm(), 0.005);
    EXPECT_FALSE(poses[k]["grasps"].empty()) << "there is a table";
  }
}

TEST_F(OfflineLabelsTest, AreRefusedInOneLineWhereTheyAreOfNoUse) {
  const std::string input = "--input " + Path("scene.pcd"), out = " --json " + Path("out.json");
  const auto refuse = [&](const std::string& labels, const std::string& says) {
    ExpectRefusal(input + out + " --labels " + Path(labels), says);
  };
  refuse("absent.png", "absent.png");
  Write("text.png", "This is no image at all, whatever it is called.");
  refuse("text.png", "not a PNG");
  cv::imwrite(Path("grey.png"), cv::Mat(240, 320, CV_8U, cv::Scalar(1)));
  refuse("grey.png", "16-bit grey PNG");
  cv::imwrite(Path("colour.png"), cv::Mat(240, 320, CV_16UC3, cv::Scalar(1, 2, 3)));
  refuse("colour.png", "16-bit grey PNG");
  cv::imwrite(Path("small.png"), cv::Mat(120, 160, CV_16U, cv::Scalar(1)));
  refuse("small.png", "expected the scene's 320x240");
  cv::imwrite(Path("empty.png"), cv::Mat(240, 320, CV_16U, cv::Scalar(0)));
  refuse("empty.png", "labels no pixel");
  Write("cut.png", Read("labels.png").substr(0, 60));
  refuse("cut.png", "damaged");
  std::string flipped = Read("labels.png");
  flipped[flipped.size() / 2] ^= 1;
  Write("flipped.png", flipped);
  refuse("flipped.png", "damaged");
  cv::imwrite(Path("full.png"), cv::Mat(240, 320, CV_16U, cv::Scalar(1)));
  refuse("full.png", "no table found");

  const std::string labels = " --labels " + Path("labels.png");
  Write("loose.xyz", "0 0 1\n0 0.1 1\n0.1 0 1\n");
  ExpectRefusal("--input " + Path("loose.xyz") + labels + out, "not organised");
  ExpectRefusal(input + " " + Path("scene.pcd") + labels + out, "one --input");
  Write("list.jsonl", "{\"file\": \"scene.pcd\"}\n");
  ExpectRefusal("--list " + Path("list.jsonl") + labels + out, "one --input");
  ExpectRefusal(input + labels, "--json");
  ExpectRefusal("--labels " + Path("labels.png"), "--json");
}

TEST(PosesJson, HasAlternativesAndParts) {
  CloudPose pose;
  pose.request.file = "a.pcd";
  pose.estimate.fit.alternatives = {MakeShape({0.01, 0.02, 0.03}, 0.1, 1, {1, 2, 3})};
  pose.estimate.fit.parts = {MakeShape({1, 2, 3}, 0.4, 0.5), MakeShape({4, 5, 6}, 0.4, 0.5)};
  const json told = json::parse(PosesToJson({pose}, "adaptive"))[0];
  EXPECT_FALSE(told.contains("label"));
  ASSERT_EQ(told["alternatives"].size(), 1u);
  EXPECT_EQ(told["alternatives"][0],
            json::parse(R"({"position": [1, 2, 3], "rotation": [1, 0, 0, 0], "taper": [0, 0],
                            "semi_axes": [0.01, 0.02, 0.03], "epsilon": [0.1, 1]})"));
  ASSERT_EQ(told["parts"].size(), 2u);
  EXPECT_EQ(told["parts"][1]["semi_axes"], json::parse("[4, 5, 6]"));
}

}  // namespace
}  // namespace beckon::pose
