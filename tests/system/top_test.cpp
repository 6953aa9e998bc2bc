// `beckon top --once` among real processes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <lcm/lcm-cpp.hpp>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/system/live_system.h"

namespace beckon::system_test {
namespace {

using ::testing::HasSubstr;

class TopTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!BusObstacle().empty()) GTEST_SKIP() << BusObstacle();
  }
  static Output Top(std::vector<std::string> args) {
    args.insert(args.begin(), {"top", "--lcm-url", LcmUrl()});
    return RunProgram(BECKON_BIN_DIR "/beckon", args);
  }
  static tool::ProcessSpec Decoder() {
    tool::ProcessSpec spec;
    spec.name = "decoder";
    spec.program = BECKON_BIN_DIR "/beckon-simulated-decoder";
    spec.args = {"--want", "Open:Carton", "--lcm-url", LcmUrl()};
    return spec;
  }
};

TEST_F(TopTest, PrintsATableOfWhoIsThere) {
  LiveSystem system;
  system.Start(tool::CaptureSpec(system.config()), tool::Supervisor::Restart::kAlways);
  system.Start(Decoder(), tool::Supervisor::Restart::kAlways);
  ASSERT_TRUE(system.RunUntil([&] {
    return system.watch().StatusOf("capture") && system.watch().StatusOf("simulated_decoder");
  })) << system.Logs();
  const auto output = Top({"--once"});
  EXPECT_EQ(output.code, 0) << output.text;
  const auto lines = output.lines();
  ASSERT_EQ(lines.size(), 6u) << output.text;
  EXPECT_THAT(lines[0], HasSubstr("2 processes, 1 host"));
  EXPECT_THAT(lines[1], HasSubstr("SERVICE"));
  EXPECT_THAT(lines[2], HasSubstr("capture"));
  EXPECT_THAT(lines[3], HasSubstr("showing"));
  EXPECT_THAT(lines[4], HasSubstr("simulated_d"));
  EXPECT_EQ(output.text.find('\x1b'), std::string::npos);
}

TEST_F(TopTest, TellsRatesAndRefusals) {
  LiveSystem system;
  system.Start(tool::CaptureSpec(system.config()), tool::Supervisor::Restart::kAlways);
  system.Start(Decoder(), tool::Supervisor::Restart::kAlways);
  const auto refused = [&] {
    const auto* status = system.watch().StatusOf("simulated_decoder");
    if (status == nullptr) return false;
    return std::ranges::any_of(status->counters, [](const msg::Counter& counter) {
      return counter.name.starts_with("refused.") && counter.value > 0;
    });
  };
  lcm::LCM stranger(LcmUrl());
  ASSERT_TRUE(stranger.good());
  ASSERT_TRUE(system.RunUntil([&] {
    stranger.publish("BECKON_STIMULUS", "garbage", 7);
    return refused();
  })) << system.Logs();
  // Two STATUSes of each, on a busy machine too.
  const auto output = Top({"--json", "--wait", "8"});
  ASSERT_EQ(output.code, 0) << output.text;
  std::set<std::string> services;
  const auto table = nlohmann::json::parse(output.text);
  for (const auto& row : table["processes"]) {
    services.insert(row["service"]);
    EXPECT_GT(row["rss_kb"], 1000);
    EXPECT_EQ(row["silent"], false);
    if (row["service"] == "capture") {
      EXPECT_GT(row["frames_per_s"], 0) << row;
    } else {
      EXPECT_GT(row["refused"]["malformed"]["total"], 0) << row;
    }
  }
  EXPECT_EQ(services, (std::set<std::string>{"capture", "simulated_decoder"}));
}

TEST_F(TopTest, SaysThatNobodyIsThere) {
  const auto output = Top({"--once", "--wait", "0.3"});
  EXPECT_EQ(output.code, 1);
  EXPECT_THAT(output.text, HasSubstr("nobody is heard"));
  EXPECT_EQ(Top({"--json", "--wait", "0.3"}).code, 1);
}

TEST_F(TopTest, WantsATerminalForTheLiveTable) {
  const auto output = Top({});
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.text, HasSubstr("--once"));
}

}  // namespace
}  // namespace beckon::system_test
