// What an input must show before anybody can talk about it.
#include "tools/beckon/scene_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tools/beckon/run_folder.h"

namespace beckon::tool {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

msg::Scene See(const std::string& source, bool table, int objects) {
  msg::Scene scene;
  scene.source = source;
  scene.has_table = table;
  scene.objects.resize(static_cast<size_t>(objects));
  return scene;
}

TEST(SceneCheck, IsCompleteWhenAStillImageWasSeenTwice) {
  SceneCheck check(1);
  EXPECT_FALSE(check.saw_scene());
  check.OnScene(See("wall.pcd", false, 0));
  EXPECT_TRUE(check.saw_scene());
  EXPECT_FALSE(check.complete());
  check.OnScene(See("wall.pcd", false, 0));
  EXPECT_TRUE(check.complete());
  EXPECT_FALSE(check.usable());
  EXPECT_THAT(check.Complaint("--input wall.pcd", "no table in view: 1 plane, but steep"),
              AllOf(HasSubstr("--input wall.pcd: no table was found (1 plane, but steep)"),
                    HasSubstr("expected a camera that looks down at a table"),
                    HasSubstr("perception.toml"), Not(HasSubstr("\n"))));
}

TEST(SceneCheck, IsCompleteWhenEveryImageOfAFolderWasSeen) {
  SceneCheck check(3);
  for (const char* source : {"a", "b", "a", "b"}) check.OnScene(See(source, false, 0));
  EXPECT_FALSE(check.complete());
  check.OnScene(See("c", true, 0));
  EXPECT_TRUE(check.complete());
  EXPECT_THAT(check.Complaint("--input f", "0 objects"),
              HasSubstr("a table was found (3 images seen), but no object on it;"));
}

TEST(SceneCheck, OneUsableImageIsEnough) {
  SceneCheck check(2);
  for (const auto& scene : {See("a", false, 0), See("b", true, 2), See("a", false, 0)})
    check.OnScene(scene);
  EXPECT_TRUE(check.usable());
}

TEST(SceneCheck, CountsTheImagesThatCaptureShows) {
  auto folder = RunFolder::Make("", "beckon-scene-check");
  EXPECT_EQ(CountImages(folder->path()), 1u);
  for (const char* name : {"a.pcd", "b.PLY", "c.xyz", "notes.txt"})
    std::ofstream(folder->path() + "/" + name) << "x";
  EXPECT_EQ(CountImages(folder->path()), 3u);
  EXPECT_EQ(CountImages(folder->path() + "/a.pcd"), 1u);
  EXPECT_EQ(CountImages(""), 1u);
}

}  // namespace
}  // namespace beckon::tool
