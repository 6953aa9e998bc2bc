// The offline mode as users run it: lists in, JSON and pictures out, one clear line on bad input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "services/base/ply_file.h"
#include "services/pose/pose_files.h"
#include "tests/pose/program.h"
#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class OfflineTest : public ProgramTest {
 protected:
  void WriteCloud(const std::string& name, const std::vector<Eigen::Vector3f>& points) const {
    std::ostringstream text;
    for (const auto& p : points) text << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
    Write(name, text.str());
  }

  const TableView box_ =
      ViewOnTable(MakeShape({0.03, 0.04, 0.06}, 0.1, 0.1, {0, 0, 0.06}, {0, 0, 0.5}), 2000, 0.001);
  const TableView can_ =
      ViewOnTable(MakeShape({0.03, 0.03, 0.06}, 0.1, 1, {0, 0, 0.06}), 2000, 0.001);
};

std::string ListLine(const std::string& file, const Plane& plane) {
  return json{{"file", file},
              {"plane", {plane.normal.x(), plane.normal.y(), plane.normal.z(), plane.offset_m}}}
             .dump() +
         "\n";
}

TEST_F(OfflineTest, FitsAListInItsOrder) {
  fs::create_directories(dir_ / "clouds");
  WriteCloud("clouds/box.xyz", box_.points_C);
  WriteCloud("clouds/can.xyz", can_.points_C);
  Write("list.jsonl",
        ListLine("clouds/can.xyz", can_.table_C) + "\n" + ListLine("clouds/box.xyz", box_.table_C));
  ASSERT_EQ(Run("--list " + Path("list.jsonl") + " --json " + Path("out.json") + " --picture " +
                Path("out.png") + " --mesh " + Path("out.ply") + " --repeat 3"),
            0)
      << error_;
  const json poses = json::parse(Read("out.json"));
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0]["file"], "clouds/can.xyz");
  EXPECT_EQ(poses[1]["file"], "clouds/box.xyz");
  for (int i = 0; i < 2; ++i) {
    const json& pose = poses[static_cast<size_t>(i)];
    const Eigen::Vector3d truth = (i == 0 ? can_ : box_).shape_C.X_FO.translation();
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(pose["position"][static_cast<size_t>(k)].get<double>(), truth[k], 0.002);
    EXPECT_EQ(pose["rotation"].size(), 4u);
    EXPECT_EQ(pose["semi_axes"].size(), 3u);
    EXPECT_EQ(pose["epsilon"].size(), 2u);
    EXPECT_EQ(pose["taper"].size(), 2u);
    EXPECT_EQ(pose["covariance"].size(), 6u);
    EXPECT_TRUE(pose["converged"].get<bool>());
    EXPECT_TRUE(pose["ambiguous"].is_boolean());
    EXPECT_GT(pose["mean_radial_distance_m"].get<double>(), 0);
    EXPECT_GT(pose["time_ms"].get<double>(), 0);
    ASSERT_FALSE(pose["grasps"].empty());
    EXPECT_GT(pose["grasps"][0]["opening_m"].get<double>(), 0);
  }
  EXPECT_EQ(Read("out.png").substr(1, 3), "PNG");
  const auto mesh = cloud::ParsePly(Read("out.ply"));
  ASSERT_TRUE(mesh) << mesh.error().message;
  ASSERT_EQ(mesh->points.size() % 2, 0u);
  const Eigen::Vector3d pole = mesh->points[0].cast<double>();  // the can's, the first in the list
  EXPECT_LT((pole - can_.shape_C.X_FO.translation()).norm(), 0.07);
}

TEST_F(OfflineTest, FitsInputsWithAndWithoutAPlane) {
  WriteCloud("box.xyz", box_.points_C);
  const Plane& t = box_.table_C;
  std::ostringstream plane;
  plane << t.normal.x() << ',' << t.normal.y() << ',' << t.normal.z() << ',' << t.offset_m;
  const std::string input = "--input " + Path("box.xyz") + " --json " + Path("out.json");
  ASSERT_EQ(Run(input + " --plane " + plane.str() + " --method multiscale"), 0) << error_;
  EXPECT_EQ(json::parse(Read("out.json"))[0]["method"], "multiscale");
  ASSERT_EQ(Run(input), 0) << error_;
  EXPECT_TRUE(json::parse(Read("out.json"))[0]["grasps"].empty());
}

// A can with a smaller one on top, which has parts, and one that is cut short, which is ambiguous.
TEST_F(OfflineTest, GivesTheSameBytesInEveryProcess) {
  std::vector<Eigen::Vector3f> bottle = can_.points_C, cut = box_.points_C;
  const TableView neck =
      ViewOnTable(MakeShape({0.012, 0.012, 0.03}, 0.1, 1, {0, 0, 0.15}), 500, 0.001);
  bottle.insert(bottle.end(), neck.points_C.begin(), neck.points_C.end());
  CutAway(0, 0.4, cut);
  WriteCloud("bottle.xyz", bottle);
  WriteCloud("box.xyz", box_.points_C);
  WriteCloud("cut.xyz", cut);
  WriteCloud("five.xyz", {box_.points_C.begin(), box_.points_C.begin() + 5});
  Write("list.jsonl", ListLine("bottle.xyz", can_.table_C) + ListLine("box.xyz", box_.table_C) +
                          ListLine("cut.xyz", box_.table_C) + ListLine("five.xyz", box_.table_C));
  for (const std::string method : {"adaptive", "multiscale", "classic", "hierarchical"}) {
    SCOPED_TRACE(method);
    ExpectSameBytesTwice("--list " + Path("list.jsonl") + " --method " + method);
    if (method != "adaptive") continue;
    const json poses = json::parse(Read("first.json"));
    EXPECT_GT(poses[0]["parts"].size(), 1u);
    EXPECT_FALSE(poses[1]["grasps"].empty());
    const std::string mesh = Read("first.ply");
    for (const char* face_of : {" 1 0\n", " 1 1\n", " 1 2\n", " 2 0\n", " 3 0\n"}) {
      EXPECT_THAT(mesh, HasSubstr(face_of));
    }
    EXPECT_THAT(mesh, Not(HasSubstr(" 4 0\n"))) << "did not converge";
  }
}

TEST_F(OfflineTest, TellsWhyACloudWasNotFitted) {
  WriteCloud("five.xyz", {box_.points_C.begin(), box_.points_C.begin() + 5});
  ASSERT_EQ(Run("--input " + Path("five.xyz") + " --json " + Path("out.json")), 0) << error_;
  const json pose = json::parse(Read("out.json"))[0];
  EXPECT_FALSE(pose["converged"].get<bool>());
  EXPECT_THAT(pose["reason"].get<std::string>(), HasSubstr("fewer than 20"));
  for (const auto& a : pose["semi_axes"]) EXPECT_GT(a.get<double>(), 0);
}

TEST_F(OfflineTest, RefusesBadInputInOneLine) {
  WriteCloud("box.xyz", box_.points_C);
  const std::string json_out = " --json " + Path("out.json");
  const std::string box = "--input " + Path("box.xyz");
  ExpectRefusal("--input " + Path("absent.xyz") + json_out, "absent.xyz");
  ExpectRefusal("--list " + Path("absent.jsonl") + json_out, "absent.jsonl");
  ExpectRefusal(box + json_out + " --method guess", "adaptive, multiscale");
  ExpectRefusal(box + json_out + " --plane 0,0,1", "4 numbers");
  ExpectRefusal(box + json_out + " --plane 0,0,0,1", "not zero");
  ExpectRefusal(box + json_out + " --plane a,b,c,d", "found 'a'");
  ExpectRefusal(box, "--json");
  ExpectRefusal("--json " + Path("out.json"), "--input");
  ExpectRefusal(box + " --json " + Path("no/such/folder.json"), "cannot be written");
  ExpectRefusal(box + json_out + " --picture " + Path("out.nonsense"), "cannot be written");
  ExpectRefusal(box + json_out + " --repeat 0", "--repeat");
}

TEST_F(OfflineTest, NamesTheLineOfAListThatIsWrong) {
  WriteCloud("box.xyz", box_.points_C);
  const std::string good = ListLine("box.xyz", box_.table_C);
  const std::string run = "--list " + Path("list.jsonl") + " --json " + Path("out.json");
  for (const char* bad :
       {"{bad", "[]", "{\"plane\": [0,0,1,0]}", "{\"file\": 3}",
        "{\"file\": \"box.xyz\", \"plane\": [0,0,1]}",
        "{\"file\": \"box.xyz\", \"plane\": [0,0,\"x\",1]}",
        "{\"file\": \"box.xyz\", \"plane\": [0,0,0,1]}", "{\"file\": \"absent.pcd\"}"}) {
    Write("list.jsonl", good + bad + "\n");
    ExpectRefusal(run, "list.jsonl:2");
  }
  Write("list.jsonl", "\n");
  ExpectRefusal(run, "names no cloud");
}

TEST_F(OfflineTest, ChecksItsConfiguration) {
  Write("good.toml", "method = 'multiscale'\n");
  Write("bad.toml", "methud = 'multiscale'\n");
  EXPECT_EQ(Run("--check-config --config " + Path("good.toml")), 0) << error_;
  ExpectRefusal("--check-config --config " + Path("bad.toml"), "methud");
}

TEST(PlaneText, IsNormalised) {
  const auto plane = ParsePlane("0,-2,0,1");
  ASSERT_TRUE(plane);
  EXPECT_EQ(plane->normal, Eigen::Vector3d(0, -1, 0));
  EXPECT_EQ(plane->offset_m, 0.5);
  for (const char* bad : {"", "1", "1,2,3,4,5", "nan,0,0,1", "0,0,1,inf", "1,2,,4", "1,2,3,4x"}) {
    EXPECT_FALSE(ParsePlane(bad)) << bad;
  }
}

}  // namespace
}  // namespace beckon::pose
