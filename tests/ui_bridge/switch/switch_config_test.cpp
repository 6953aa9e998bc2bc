#include "services/ui_bridge/switch/switch_config.h"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>

namespace beckon::ui_bridge {
namespace {

Status Read(const std::string& text, SwitchConfig& config) {
  auto table = ConfigTable::Parse(text, "test.toml");
  if (!table) return table.error();
  ReadSwitchConfig(table->Section("switch"), config);
  if (const Status right = table->Finish(); !right) return right;
  return ValidateSwitch(config);
}

TEST(SwitchSettings, AreItsDefaultsInTheShippedFileKeyByKey) {
  std::ifstream file(std::string(BECKON_SOURCE_DIR) + "/services/ui_bridge/switch/switch.toml");
  ASSERT_TRUE(file);
  std::stringstream text;
  text << file.rdbuf();
  // Every key stands in it as a comment: "# key = value".
  const std::string live =
      std::regex_replace(text.str(), std::regex("(^|\n)# ([a-z_]+ = )"), "$1$2");
  ASSERT_NE(live, text.str());
  SwitchConfig config;
  const SwitchConfig defaults;
  const Status read = Read(live, config);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(config.scan.scan_us, defaults.scan.scan_us);
  EXPECT_EQ(config.scan.first_us, defaults.scan.first_us);
  EXPECT_EQ(config.scan.stop_hold_us, defaults.scan.stop_hold_us);
  EXPECT_EQ(config.scan.long_press_us, defaults.scan.long_press_us);
  EXPECT_EQ(config.scan.press_us, defaults.scan.press_us);
  EXPECT_EQ(config.scan.guard_us, defaults.scan.guard_us);
  EXPECT_EQ(config.scan.rounds, defaults.scan.rounds);
  EXPECT_EQ(config.scan.control_share, defaults.scan.control_share);
  EXPECT_EQ(config.device, defaults.device);
  EXPECT_EQ(config.voice, defaults.voice);
  EXPECT_EQ(config.max_options, defaults.max_options);
  EXPECT_EQ(config.seconds_a_letter, defaults.seconds_a_letter);
  EXPECT_EQ(config.false_yes, defaults.false_yes);
}

TEST(SwitchSettings, ThatDoNotWorkTogetherAreRefused) {
  for (const auto& [text, reason] : {
           std::pair{"method = 'inverse'", "release"},
           {"method = 'step'\nselect = 'long-press'", "release"},
           {"resume = 'hold'", "twice"},
           {"device = '/dev/input/event3'\nmethod = 'step'", "select_key"},
           {"device = ''", "device"},
           {"key = 'KEY_NONE'", "KEY_NONE"},
           {"voice = []", "voice"},
           {"max_options = 1", "max_options"},
           {"false_yes = 0.9", "false_yes"},
           {"scan_tine = 1", "scan_time"},
       }) {
    SwitchConfig config;
    const Status read = Read(std::string("[switch]\n") + text, config);
    ASSERT_FALSE(read) << text;
    EXPECT_NE(read.error().message.find(reason), std::string::npos) << read.error().message;
  }
}

TEST(SwitchSettings, MakeOneOrTwoDevices) {
  SwitchConfig config;
  ASSERT_TRUE(Read("[switch]\ndevice = '/a'\nkey = 'BTN_0'\nselect_key = 'BTN_1'", config));
  ASSERT_EQ(EventDevices(config).size(), 1u);
  EXPECT_EQ(EventDevices(config)[0].main.code, 256);
  EXPECT_EQ(EventDevices(config)[0].select.code, 257);
  config = {};
  ASSERT_TRUE(Read("[switch]\ndevice = '/a'\nselect_device = '/b'\nmethod = 'step'", config));
  ASSERT_EQ(EventDevices(config).size(), 2u);
  EXPECT_EQ(EventDevices(config)[1].select.code, KeyChoice::kAny);
  EXPECT_EQ(EventDevices(config)[1].main.code, KeyChoice::kNone);
}

}  // namespace
}  // namespace beckon::ui_bridge
