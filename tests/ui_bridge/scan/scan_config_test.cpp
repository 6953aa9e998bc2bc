#include "services/ui_bridge/scan/scan_config.h"

#include <gtest/gtest.h>

namespace beckon::ui_bridge::scan {
namespace {

Result<Config> Read(const std::string& text) {
  auto table = ConfigTable::Parse(text, "test.toml");
  if (!table) return table.error();
  Config config;
  ReadScanConfig(*table, config);
  if (const Status right = table->Finish(); !right) return right.error();
  return config;
}

TEST(ScanConfigFile, SaysHowAScanGoes) {
  const auto config = Read(
      "method = 'step'\nselect = 'long-press'\ngrouping = 'binary'\nscan_time = 0.9\n"
      "stop_hold = 3\nback = 'entry'\nresume = 'hold'\naccept = 'press'\nrounds = 0");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->method, Method::kStep);
  EXPECT_EQ(config->step_select, StepSelect::kLongPress);
  EXPECT_EQ(config->grouping, Grouping::kBinary);
  EXPECT_EQ(config->scan_us, 900'000);
  EXPECT_EQ(config->stop_hold_us, 3 * kSecond);
  EXPECT_EQ(config->back, Back::kEntry);
  EXPECT_EQ(config->resume_by, ResumeBy::kHold);
  EXPECT_EQ(config->accept, Accept::kPress);
  EXPECT_EQ(config->rounds, 0);
}

TEST(ScanConfigFile, IsItsDefaultsWhereItIsEmpty) {
  const auto config = Read("");
  ASSERT_TRUE(config);
  EXPECT_EQ(config->scan_us, Config{}.scan_us);
  EXPECT_EQ(config->method, Method::kAutomatic);
}

TEST(ScanConfigFile, IsRefusedWithTheReason) {
  for (const auto& [text, reason] : {std::pair{"method = 'auto'", "automatic"},
                                     {"scan_time = 0", "scan_time"},
                                     {"scan_tme = 1", "scan_time"},
                                     {"hold_time = 2\nstop_hold = 1", "shorter"},
                                     {"scan_time = nan", "scan_time"},
                                     {"rounds = -1", "rounds"}}) {
    const auto config = Read(text);
    ASSERT_FALSE(config) << text;
    EXPECT_NE(config.error().message.find(reason), std::string::npos) << config.error().message;
  }
}

}  // namespace
}  // namespace beckon::ui_bridge::scan
