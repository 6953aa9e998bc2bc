// beckon-perception as people and scripts run it on files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "services/base/cloud_file.h"
#include "tests/perception/box_world.h"

namespace beckon::perception {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Ran {
  int exit_code = -1;
  std::string output;  // standard output and error
};

Ran Execute(const std::string& arguments) {
  Ran ran;
  FILE* pipe = popen((std::string(BECKON_PERCEPTION) + " " + arguments + " 2>&1").c_str(), "r");
  char buffer[4096];
  while (size_t n = fread(buffer, 1, sizeof buffer, pipe)) ran.output.append(buffer, n);
  const int status = pclose(pipe);
  ran.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return ran;
}

fs::path DataFolder() {
  const char* data = std::getenv("BECKON_DATA");
  return data != nullptr ? fs::path(data) : fs::path(BECKON_SOURCE_DIR) / ".." / "shared" / "data";
}

class OfflineTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("beckon_perception_test_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }

  /// An organised cloud of what the camera sees in the world.
  std::string WriteCloud(const BoxWorld& world, bool organised = true) const {
    const RgbdImage image = world.Render();
    Cloud cloud;
    for (int v = 0; v < image.height; ++v) {
      for (int u = 0; u < image.width; ++u) {
        const bool seen = image.HasDepth(u, v);
        if (!seen && !organised) continue;
        cloud.points.push_back(seen ? image.Point(u, v).cast<float>().eval()
                                    : Eigen::Vector3f::Constant(std::nanf("")));
        cloud.colours.push_back(image.colour[image.Index(u, v)]);
      }
    }
    cloud.width = organised ? image.width : static_cast<int>(cloud.points.size());
    cloud.height = organised ? image.height : 1;
    const std::string path = Path(organised ? "organised.pcd" : "unorganised.pcd");
    EXPECT_TRUE(WritePcdFile(path, cloud));
    return path;
  }

  json ReadJson(const std::string& name) const { return json::parse(std::ifstream(Path(name))); }

  fs::path folder_;
};

void ExpectThreeObjects(const json& result, const cv::Mat& labels) {
  ASSERT_EQ(result["objects"].size(), 3u);
  ASSERT_EQ(labels.type(), CV_16U);
  EXPECT_EQ(result["table"]["normal"].size(), 3u);
  EXPECT_NEAR(result["table"]["offset_m"], 0.6, 0.01);
  for (const auto& object : result["objects"]) {
    EXPECT_EQ(object["category"], "Unknown");
    EXPECT_EQ(object["confidence"], 0);
    EXPECT_TRUE(object["probabilities"].is_object());
    EXPECT_TRUE(object["ask_user"].is_boolean());
    EXPECT_EQ(object["centroid_C"].size(), 3u);
    int pixels = 0;
    for (auto it = labels.begin<uint16_t>(); it != labels.end<uint16_t>(); ++it) {
      pixels += *it == object["id"].get<int>();
    }
    EXPECT_EQ(pixels, object["points"].get<int>());
  }
  for (const char* key : {"segmentation", "categorisation", "total"}) {
    EXPECT_GE(result["timing_ms"][key].get<double>(), 0) << key;
  }
}

TEST_F(OfflineTest, WritesJsonLabelsAndAPicture) {
  const Ran ran =
      Execute("--input " + WriteCloud(ThreeBoxes()) + " --no-categories --segmentation reference" +
              " --repeat 3 --threads 1 --json " + Path("o.json") + " --labels " + Path("l.png") +
              " --picture " + Path("p.png"));
  ASSERT_EQ(ran.exit_code, 0) << ran.output;
  EXPECT_EQ(ran.output, "");
  const cv::Mat labels = cv::imread(Path("l.png"), cv::IMREAD_UNCHANGED);
  EXPECT_EQ(labels.size(), cv::Size(320, 240));
  ExpectThreeObjects(ReadJson("o.json"), labels);
  EXPECT_EQ(cv::imread(Path("p.png")).size(), cv::Size(320, 240));
}

TEST_F(OfflineTest, DrawsEveryStageOfBothMethods) {
  const std::string input = "--input " + WriteCloud(ThreeBoxes()) + " --no-categories --json " +
                            Path("o.json") + " --picture " + Path("p.png") + " --segmentation ";
  for (const auto& [method, stages] :
       {std::pair("fast", std::vector{"grid", "table", "surface", "patches", "grouping", "labels"}),
        std::pair("reference",
                  std::vector{"range_voxels", "plane", "hull", "prism", "clusters", "labels"})}) {
    std::set<std::string> pictures;
    for (const std::string stage : stages) {
      const Ran ran = Execute(input + method + " --stage " + stage);
      ASSERT_EQ(ran.exit_code, 0) << ran.output;
      EXPECT_EQ(cv::imread(Path("p.png")).size(), cv::Size(320, 240));
      std::ifstream png(Path("p.png"), std::ios::binary);
      pictures.insert(std::string(std::istreambuf_iterator<char>(png), {}));
      EXPECT_TRUE(ReadJson("o.json")["steps_ms"].contains(stage)) << stage;
    }
    EXPECT_EQ(pictures.size(), stages.size());
    const Ran wrong = Execute(input + method + " --stage magic");
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_THAT(wrong.output, testing::HasSubstr(stages.front() + std::string(", ")));
  }
}

TEST_F(OfflineTest, TakesUnorganisedCloudsOnAGridOf640x480) {
  BoxWorld world = ThreeBoxes();
  world.width = 640;
  world.height = 480;
  const Ran ran = Execute("--input " + WriteCloud(world, false) + " --no-categories --json " +
                          Path("o.json") + " --labels " + Path("l.png"));
  ASSERT_EQ(ran.exit_code, 0) << ran.output;
  const cv::Mat labels = cv::imread(Path("l.png"), cv::IMREAD_UNCHANGED);
  EXPECT_EQ(labels.size(), cv::Size(640, 480));
  ExpectThreeObjects(ReadJson("o.json"), labels);
}

TEST_F(OfflineTest, WithoutATableTellsTheReasonAndSucceeds) {
  BoxWorld world;
  world.pitch_deg = 5;
  world.boxes = {{{-3, 1.5, -1}, {3, 1.6, 3}}};
  const Ran ran =
      Execute("--input " + WriteCloud(world) + " --no-categories --json " + Path("o.json") +
              " --labels " + Path("l.png") + " --picture " + Path("p.png"));
  ASSERT_EQ(ran.exit_code, 0) << ran.output;
  const json result = ReadJson("o.json");
  EXPECT_TRUE(result["table"].is_null());
  EXPECT_FALSE(result["reason"].get<std::string>().empty());
  EXPECT_TRUE(result["objects"].empty());
  EXPECT_EQ(cv::countNonZero(cv::imread(Path("l.png"), cv::IMREAD_UNCHANGED)), 0);
}

TEST_F(OfflineTest, BadInputIsOneClearLineAndExitCodeTwo) {
  std::ofstream(Path("garbage.pcd")) << "this is no cloud";
  std::ofstream(Path("empty.pcd"));
  std::ofstream(Path("wrong.toml")) << "[segmentation]\nvoxels = 1\n";
  const std::string good = WriteCloud(ThreeBoxes());
  for (const std::string& arguments :
       {"--input " + Path("none.pcd"), "--input " + Path("garbage.pcd"),
        "--input " + Path("empty.pcd"), "--input " + good + " --segmentation magic",
        "--input " + good + " --model " + Path("none.model"),
        "--input " + good + " --no-categories --json /no/such/folder/o.json",
        "--input " + good + " --no-categories --json " + Path("o.json") +
            " --labels /no/such/l.png",
        "--input " + good + " --repeat 0", std::string("--json x.json"), std::string("--what"),
        "--check-config --config " + Path("wrong.toml")}) {
    const Ran ran = Execute(arguments);
    EXPECT_EQ(ran.exit_code, 2) << arguments << "\n" << ran.output;
    EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << ran.output;
    EXPECT_THAT(ran.output, testing::StartsWith("beckon-perception: ")) << arguments;
  }
}

TEST_F(OfflineTest, ConfigurationsAndVersionsCanBeAsked) {
  EXPECT_EQ(
      Execute("--check-config --config " BECKON_SOURCE_DIR "/services/perception/perception.toml")
          .exit_code,
      0);
  EXPECT_THAT(Execute("--version").output, testing::StartsWith("beckon-perception "));
  EXPECT_THAT(Execute("--help").output, testing::HasSubstr("--segmentation"));
  EXPECT_THAT(Execute("--list-categories").output, testing::HasSubstr("Carton\nCup\n"));
}

TEST_F(OfflineTest, PerceivesRealScenesTheSameEveryTime) {
  const fs::path folder = DataFolder() / "osd";
  if (!fs::exists(folder / "learn40.pcd")) {
    GTEST_SKIP() << "no real scenes in " << folder << " (set BECKON_DATA)";
  }
  // Objects far enough apart for the reference method, as people count them.
  for (const auto& [name, n_objects] : {std::pair("learn0", 2), std::pair("learn40", 3)}) {
    const std::string input = "--input " + (folder / name).string() + ".pcd --no-categories";
    std::string first;
    for (int run = 0; run < 2; ++run) {
      const Ran ran = Execute(input + " --json " + Path("o.json") + " --labels " + Path("l.png"));
      ASSERT_EQ(ran.exit_code, 0) << ran.output;
      json result = ReadJson("o.json");
      EXPECT_EQ(result["objects"].size(), static_cast<size_t>(n_objects)) << name;
      result.erase("timing_ms");
      result.erase("steps_ms");
      std::ifstream png(Path("l.png"), std::ios::binary);
      const std::string told = result.dump() + std::string(std::istreambuf_iterator<char>(png), {});
      if (run == 0) first = told;
      EXPECT_EQ(told, first) << name;
    }
  }
}

}  // namespace
}  // namespace beckon::perception
