// What a picture of a demo is made of, and that it is made.
#include "tools/beckon/demo_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "lcmtypes/frame_image.h"
#include "tools/beckon/run_folder.h"

namespace beckon::tool {
namespace {

msg::Frame Frame(int64_t seq) {
  RgbdImage image{.width = 64, .height = 48, .depth_m = std::vector<float>(64 * 48, 1.0F)};
  image.colour.assign(64 * 48, Rgb{90, 120, 60});
  msg::Frame frame;
  EXPECT_TRUE(EncodeImage(image, 0.001, 90, frame));
  frame.seq = seq;
  return frame;
}

msg::Scene Scene(int64_t seq) {
  msg::Scene scene;
  scene.seq = seq;
  scene.frame_seq = seq + 10;
  scene.has_table = true;
  scene.objects.resize(2);
  for (int i = 0; i < 2; ++i) {
    auto& object = scene.objects[static_cast<size_t>(i)];
    object.id = i + 1;
    object.category = "Carton";
    object.centroid_W = {i * 0.1, 0, 1};
    const auto u = static_cast<int16_t>(10 + 30 * i);
    const auto right = static_cast<int16_t>(u + 20);
    object.outline_px = {{u, 10}, {right, 10}, {right, 40}, {u, 40}};
  }
  return scene;
}

msg::Poses Poses(int64_t scene_seq) {
  msg::Poses poses;
  poses.scene_seq = scene_seq;
  poses.poses.resize(1);
  poses.poses[0].object_id = 1;
  poses.poses[0].semi_axes = {0.02, 0.03, 0.04};
  poses.poses[0].X_WO.translation() = Eigen::Vector3d(0, 0, 1);
  poses.poses[0].converged = true;
  return poses;
}

DemoStory Story() {
  DemoStory story;
  for (const int64_t seq : {1, 2, 3}) {
    story.OnFrame(Frame(seq + 10));
    story.OnScene(Scene(seq));
    story.OnPoses(Poses(seq));
  }
  msg::Query query;
  query.scene_seq = 2;
  story.OnQuery(query);
  return story;
}

SessionRecord Session(int answers) {
  SessionRecord record;
  for (int i = 0; i < answers; ++i)
    record.answers.push_back({i, msg::QueryKind::kFull, "Open the carton?", "No", 0});
  record.task.emplace();
  record.task->has_pose = true;
  record.task->pose = Poses(2).poses[0];
  record.task->pose.grasps.push_back({Pose(Eigen::Translation3d(0, 0, 1)), 0.05, 1});
  return record;
}

TEST(DemoStory, KeepsTheSceneThatWasAskedAboutWithItsFrame) {
  auto story = Story();
  ASSERT_TRUE(story.scene());
  ASSERT_TRUE(story.frame());
  EXPECT_EQ(story.scene()->seq, 2);
  EXPECT_EQ(story.frame()->seq, 12);
  story.OnFrame(Frame(14));
  story.OnScene(Scene(4));
  EXPECT_EQ(story.scene()->seq, 2);
  EXPECT_EQ(story.poses().size(), 1u);
}

TEST(DemoStory, WaitsForASceneThatComesAfterItsQuestion) {
  DemoStory story;
  msg::Query query;
  query.scene_seq = 1;
  story.OnQuery(query);
  EXPECT_FALSE(story.scene());
  story.OnFrame(Frame(11));
  story.OnScene(Scene(1));
  EXPECT_TRUE(story.scene());
}

TEST(DemoPicture, IsDrawnHoweverLongTheConversation) {
  auto folder = RunFolder::Make("", "beckon-picture");
  for (const int answers : {0, 5, 300}) {
    auto story = Story();
    story.OnEnd(Session(answers));
    story.OnEnd(Session(1));
    const std::string path = folder->path() + "/" + std::to_string(answers) + ".png";
    const auto drawn = WriteDemoPicture(path, story);
    ASSERT_TRUE(drawn) << drawn.error().message;
    EXPECT_GT(std::filesystem::file_size(path), 1000u);
  }
}

TEST(DemoPicture, NamesAnObjectThatIsLargerThanTheImage) {
  auto folder = RunFolder::Make("", "beckon-picture");
  DemoStory story;
  auto scene = Scene(1);
  scene.objects[0].category = std::string(60, 'W');
  scene.objects[0].outline_px = {{0, 0}, {63, 0}, {63, 47}, {0, 47}};
  story.OnFrame(Frame(11));
  story.OnScene(scene);
  msg::Query query;
  query.scene_seq = 1;
  story.OnQuery(query);
  EXPECT_TRUE(WriteDemoPicture(folder->path() + "/a.png", story));
}

TEST(DemoPicture, SaysWhatCannotBeDrawnOrWritten) {
  EXPECT_THAT(WriteDemoPicture("/tmp/a.png", DemoStory()).error().message,
              ::testing::HasSubstr("nothing was asked"));
  EXPECT_FALSE(CheckPicturePath("/nowhere/a.png"));
  EXPECT_FALSE(CheckPicturePath("a.tex"));
  EXPECT_TRUE(CheckPicturePath("a.png"));
  EXPECT_FALSE(WriteDemoPicture("/nowhere/a.png", Story()));
}

}  // namespace
}  // namespace beckon::tool
