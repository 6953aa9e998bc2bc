// Every service tells how it fares, and `beckon top` shows it.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/system/live_system.h"

namespace beckon::system_test {
namespace {

TEST(StatusOfAllServices, IsShownByTop) {
  if (!Obstacle().empty()) GTEST_SKIP() << Obstacle();
  LiveSystem system;
  system.StartServices();
  system.StartUser();
  ASSERT_TRUE(system.RunUntil([&] { return !system.sessions().empty(); })) << system.Logs();
  const auto output =
      RunProgram(BECKON_BIN_DIR "/beckon", {"top", "--json", "--wait", "8", "--lcm-url", LcmUrl()});
  ASSERT_EQ(output.code, 0) << output.text;
  const auto table = nlohmann::json::parse(output.text);
  std::map<std::string, nlohmann::json> rows;
  for (const auto& row : table["processes"]) rows[row["service"]] = row;
  for (const char* service : {"capture", "perception", "pose", "intention", "ui_bridge"}) {
    ASSERT_TRUE(rows.contains(service)) << output.text;
    const auto& row = rows[service];
    EXPECT_FALSE(row["silent"]) << row;
    EXPECT_FALSE(row["build"].get<std::string>().empty()) << row;
    EXPECT_GT(row["rss_kb"], 1000) << row;
    EXPECT_GE(row["cpu_percent"], 0) << row;
    EXPECT_GE(row["sent_per_s"], 1) << row;
  }
  for (const char* service : {"capture", "perception", "pose"})
    EXPECT_GT(rows[service]["frames_per_s"], 0) << rows[service];
  for (const char* service : {"perception", "pose", "intention"}) {
    EXPECT_GT(rows[service]["age_us"], 0) << rows[service];
    EXPECT_GT(rows[service]["handler_us"], 0) << rows[service];
  }
  EXPECT_EQ(table["last_task"].is_null() && table["talks"].empty(), false) << output.text;
}

TEST(StatusOfAllServices, HasNoCounterWithoutADescription) {
  if (!Obstacle().empty()) GTEST_SKIP() << Obstacle();
  std::ifstream file(BECKON_SOURCE_DIR "/docs/protocol.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  LiveSystem system;
  system.StartServices();
  system.StartUser();
  ASSERT_TRUE(system.RunUntil([&] { return !system.sessions().empty(); })) << system.Logs();
  for (const char* service : {"capture", "perception", "pose", "intention", "ui_bridge"}) {
    ASSERT_TRUE(system.RunUntil([&] { return system.watch().StatusOf(service); })) << service;
    for (const auto& counter : system.watch().StatusOf(service)->counters) {
      if (counter.name.find('.') != std::string::npos) continue;  // by channel
      EXPECT_NE(text.find("`" + counter.name + "`"), std::string::npos)
          << service << ": " << counter.name;
    }
  }
}

}  // namespace
}  // namespace beckon::system_test
