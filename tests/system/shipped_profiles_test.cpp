// The profiles that ship: each can be run as it is, and those of a site are the whole of Beckon.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tools/beckon/profile.h"
#include "tools/beckon/run_folder.h"

namespace beckon::tool {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

const fs::path kProfiles = fs::path(BECKON_SOURCE_DIR) / "tools/beckon/profiles";

/// Profiles by the site they are part of; one-machine is a site of its own.
std::map<std::string, std::vector<Profile>> Sites() {
  std::map<std::string, std::vector<Profile>> sites;
  for (const auto& entry : fs::recursive_directory_iterator(kProfiles)) {
    if (!entry.is_regular_file()) continue;
    const auto profile = LoadProfile(entry.path());
    EXPECT_TRUE(profile) << profile.error().message;
    if (profile) sites[*fs::relative(entry.path(), kProfiles).begin()].push_back(*profile);
  }
  return sites;
}

TEST(ShippedProfiles, TogetherRunEachServiceOnce) {
  const auto sites = Sites();
  ASSERT_EQ(sites.size(), 3u);
  EXPECT_EQ(sites.at("two-machines").size(), 2u);
  EXPECT_EQ(sites.at("three-machines").size(), 3u);
  for (const auto& [site, profiles] : sites) {
    std::vector<std::string> names;
    for (const auto& profile : profiles)
      for (const auto& process : profile.processes) names.push_back(process.name);
    EXPECT_THAT(names,
                UnorderedElementsAre("capture", "perception", "pose", "intention", "ui_bridge"))
        << site;
  }
}

TEST(ShippedProfiles, LeaveTheMachineOnlyWhereThereAreSeveral) {
  for (const auto& [site, profiles] : Sites()) {
    for (const auto& profile : profiles) {
      if (profiles.size() == 1) {
        EXPECT_EQ(profile.lcm_url, "") << "the default, which does not leave the machine";
      } else {
        EXPECT_EQ(profile.lcm_url, profiles[0].lcm_url) << site;
        EXPECT_THAT(profile.lcm_url, HasSubstr("ttl=1&recv_buf_size=2097152")) << site;
      }
    }
  }
}

TEST(ShippedProfiles, NameProgramsThatTakeTheirArguments) {
  auto folder = RunFolder::Make("", "shipped-profiles-test");
  ASSERT_TRUE(folder);
  for (const auto& [site, profiles] : Sites()) {
    for (const auto& profile : profiles) {
      for (auto spec : profile.processes) {
        spec.program = fs::path(BECKON_BIN_DIR) / fs::path(spec.program).filename();
        spec.args.emplace_back("--check-config");
        spec.log_file = folder->path() + "/" + spec.name;
        spec.terminal = false;
        auto process = ChildProcess::Start(spec);
        ASSERT_TRUE(process) << process.error().message;
        const auto exit = process->Wait(20'000);
        ASSERT_TRUE(exit) << spec.name;
        EXPECT_EQ(exit->code, 0) << site << " " << spec.name << ": " << LastLine(spec.log_file);
      }
    }
  }
}

}  // namespace
}  // namespace beckon::tool
