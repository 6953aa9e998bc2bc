// Profiles of `beckon run`.
#include "tools/beckon/profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace beckon::tool {
namespace {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

Result<Profile> Load(const std::string& toml) {
  const std::string path = ::testing::TempDir() + std::to_string(getpid()) + "_profile_test.toml";
  std::ofstream(path) << toml;
  auto profile = LoadProfile(path);
  std::filesystem::remove(path);
  return profile;
}

TEST(Profile, TheOneThatShipsRunsAllFiveServices) {
  const auto profile = LoadProfile(BECKON_SOURCE_DIR "/tools/beckon/profiles/one-machine.toml");
  ASSERT_TRUE(profile) << profile.error().message;
  std::vector<std::string> names;
  for (const auto& process : profile->processes) names.push_back(process.name);
  EXPECT_THAT(names,
              UnorderedElementsAre("capture", "perception", "pose", "intention", "ui_bridge"));
}

TEST(Profile, IsFoundByItsNameAlone) {
  EXPECT_TRUE(LoadProfile("one-machine"));
  EXPECT_TRUE(LoadProfile("two-machines/camera"));
  EXPECT_FALSE(LoadProfile("two-machines")) << "a folder of profiles is none";
}

TEST(Profile, ReadsProgramsAndArguments) {
  const auto profile =
      Load("lcm_url = \"memq://\"\n[process.a]\nprogram = \"/bin/true\"\nargs = [\"-x\", \"1\"]\n");
  ASSERT_TRUE(profile) << profile.error().message;
  EXPECT_EQ(profile->lcm_url, "memq://");
  ASSERT_EQ(profile->processes.size(), 1u);
  EXPECT_EQ(profile->processes[0].program, "/bin/true");
  EXPECT_EQ(profile->processes[0].args, (std::vector<std::string>{"-x", "1"}));
}

TEST(Profile, RefusesMistakesByName) {
  EXPECT_THAT(Load("").error().message, HasSubstr("no process"));
  EXPECT_THAT(Load("[process.a]\nargs = []\n").error().message, HasSubstr("program"));
  EXPECT_THAT(Load("[process.a]\nprogram = \"x\"\nprogramm = \"y\"\n").error().message,
              HasSubstr("programm"));
  EXPECT_THAT(Load("[process.a]\nprogram = 3\n").error().message, HasSubstr("program"));
  EXPECT_THAT(Load("[process.a]\nprogram = \"x\"\nterminal = true\n[process.b]\nprogram = "
                   "\"y\"\nterminal = true\n")
                  .error()
                  .message,
              HasSubstr("terminal"));
  EXPECT_FALSE(LoadProfile("/nowhere/profile.toml"));
}

}  // namespace
}  // namespace beckon::tool
