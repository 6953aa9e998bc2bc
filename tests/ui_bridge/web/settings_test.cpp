// Settings: what may be said, what is told of what may not, presets, and the trial that ends by
// itself.
#include "services/ui_bridge/web/settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/ui_bridge/web/settings_trial.h"
#include "tests/draws.h"

namespace beckon::ui_bridge::web {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;

std::string ErrorOf(const std::string& text) {
  const auto read = ReadSettings(Json::parse(text));
  return read ? "" : read.error().message;
}

TEST(Settings, ComeBackAsTheyWereWritten) {
  Settings settings{.access = "one_switch", .theme = "contrast", .text_percent = 175};
  settings.language = "de";
  settings.motion = "reduced";
  settings.show_shapes = false;
  settings.dwell_s = 0.7;
  settings.scan = {.method = "inverse", .grouping = "binary", .scan_time_s = 2.5};
  settings.scan.stop_hold_s = 0;
  const auto read = ReadSettings(ToJson(settings));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, settings);
}

TEST(Settings, KeepWhatIsNotSaid) {
  const Settings base{.access = "gaze", .text_percent = 150};
  const auto read = ReadSettings(Json::parse(R"({"theme": "dark", "scan": {"rounds": 7}})"), base);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->access, "gaze");
  EXPECT_EQ(read->text_percent, 150);
  EXPECT_EQ(read->theme, "dark");
  EXPECT_EQ(read->scan.rounds, 7);
  EXPECT_EQ(read->scan.scan_time_s, base.scan.scan_time_s);
}

TEST(Settings, SayWhichKeyIsWrongWhatWasExpectedAndWhatWasFound) {
  EXPECT_EQ(ErrorOf(R"({"text_percent": 90})"),
            "'text_percent': expected a whole number from 100 to 250, found 90");
  EXPECT_EQ(ErrorOf(R"({"theme": "pink"})"),
            "'theme': expected one of auto, light, dark, contrast, found \"pink\"");
  EXPECT_EQ(ErrorOf(R"({"scan": {"scan_time_s": 0.1}})"),
            "'scan.scan_time_s': expected 0.2 to 20.0, found 0.1");
  EXPECT_EQ(ErrorOf(R"({"dwell_s": 0.1})"), "'dwell_s': expected 0 or 0.3 to 5.0, found 0.1");
  EXPECT_EQ(ErrorOf(R"({"show": {"picture": "yes"}})"),
            "'show.picture': expected true or false, found \"yes\"");
  EXPECT_EQ(ErrorOf(R"({"colour": "dark"})"), "'colour': no such setting");
  EXPECT_EQ(ErrorOf(R"({"scan": {"speed": 1}})"), "'scan.speed': no such setting");
  EXPECT_THAT(ErrorOf(R"({"scan": {"hold_s": 3, "stop_hold_s": 2}})"), HasSubstr("hold"));
}

TEST(Settings, RefuseEveryWrongTypeAndRange) {
  const char* wrong[] = {R"([])",
                         R"("dark")",
                         R"({"access": 1})",
                         R"({"access": null})",
                         R"({"access": "voice"})",
                         R"({"text_percent": 100.5})",
                         R"({"text_percent": "100"})",
                         R"({"text_percent": 251})",
                         R"({"language": ""})",
                         R"({"language": "d e"})",
                         R"({"language": "../de"})",
                         R"({"language": "-de"})",
                         R"({"motion": true})",
                         R"({"show": []})",
                         R"({"show": null})",
                         R"({"show": {"a": true}})",
                         R"({"dwell_s": -1})",
                         R"({"dwell_s": 5.1})",
                         R"({"dwell_s": "1"})",
                         R"({"scan": 1})",
                         R"({"scan": {"method": "fast"}})",
                         R"({"scan": {"grouping": ""}})",
                         R"({"scan": {"rounds": -1}})",
                         R"({"scan": {"rounds": 1.5}})",
                         R"({"scan": {"stop_hold_s": 0.1}})",
                         R"({"scan": {"first_item_delay_s": 11}})",
                         R"({"scan": {"ignore_repeat_s": 1e300}})",
                         R"({"": 1})"};
  for (const char* text : wrong) EXPECT_NE(ErrorOf(text), "") << text;
}

TEST(Settings, ShortenWhatWasFoundAndShowNoRawBytes) {
  const auto read = ReadSettings({{"theme", std::string(5000, 'x') + "\xff"}});
  ASSERT_FALSE(read);
  EXPECT_LT(read.error().message.size(), 200u);
}

TEST(Settings, OfEveryPresetAreValidAndOfTheirAccess) {
  EXPECT_EQ(Presets().size(), 5u);
  for (const auto& [name, preset] : Presets()) {
    EXPECT_EQ(preset.access, name);
    const auto read = ReadSettings(ToJson(preset));
    ASSERT_TRUE(read) << name << ": " << read.error().message;
    EXPECT_EQ(preset.scans(), name.find("switch") != std::string::npos);
  }
}

/// Any settings with any value of any kind in any place: refused, or right and the same when read
/// again.
TEST(Settings, AreSoundForAnyJson) {
  int right = 0, wrong = 0;
  for (unsigned round = 0; round < 20'000; ++round) {
    Draws draws(round);
    Json json = ToJson(Settings{});
    static const Json kOdd[] = {nullptr,        true, -1,   0,           0.5,    1e9,
                                "auto",         "",   "de", "binary",    "\xff", Json::array(),
                                Json::object(), 2,    150,  "one_switch"};
    for (int i = draws.Between(1, 3); i > 0; --i) {
      Json* place = &json;
      while (place->is_object() && !place->empty() && !draws.OneIn(4))
        place = &std::next(place->begin(), static_cast<int>(draws.Index(place->size()))).value();
      *place = draws.Any(kOdd);
    }
    const auto read = ReadSettings(json);
    ++(read ? right : wrong);
    if (!read) continue;
    const auto again = ReadSettings(ToJson(*read));
    ASSERT_TRUE(again);
    ASSERT_EQ(*again, *read);
    ASSERT_TRUE(scan::Validate(ScanConfig(*read)));
  }
  EXPECT_GT(right, 100);
  EXPECT_GT(wrong, 100);
}

TEST(SettingsTrial, FallsBackByItselfUnlessKept) {
  SettingsTrial trial(Settings{.theme = "light"});
  EXPECT_FALSE(trial.on());
  EXPECT_FALSE(trial.SecondsLeft(0));
  trial.Try(kSecond, Settings{.theme = "dark"}, 20 * kSecond);
  EXPECT_EQ(trial.current().theme, "dark");
  EXPECT_EQ(trial.kept().theme, "light");
  EXPECT_EQ(trial.SecondsLeft(kSecond), 20);
  EXPECT_EQ(trial.SecondsLeft(kSecond + 1), 20);
  EXPECT_EQ(trial.SecondsLeft(2 * kSecond), 19);
  EXPECT_EQ(trial.NextDeadline(), 21 * kSecond);
  EXPECT_FALSE(trial.Tick(21 * kSecond - 1));
  EXPECT_TRUE(trial.Tick(21 * kSecond));
  EXPECT_EQ(trial.current().theme, "light");
  EXPECT_FALSE(trial.Tick(22 * kSecond));
  EXPECT_FALSE(trial.Keep(22 * kSecond));
}

TEST(SettingsTrial, CountsFromThenOnWhereItIsKept) {
  SettingsTrial trial(Settings{.theme = "light"});
  trial.Try(0, Settings{.theme = "dark"}, 20 * kSecond);
  EXPECT_TRUE(trial.Keep(19 * kSecond));
  EXPECT_FALSE(trial.Tick(30 * kSecond));
  EXPECT_EQ(trial.current().theme, "dark");
  EXPECT_EQ(trial.kept().theme, "dark");
}

TEST(SettingsTrial, IsNotKeptTooLateEvenBeforeItsEndWasNoticed) {
  SettingsTrial trial(Settings{.theme = "light"});
  trial.Try(0, Settings{.theme = "dark"}, 20 * kSecond);
  EXPECT_FALSE(trial.Keep(20 * kSecond));
  EXPECT_EQ(trial.current().theme, "light");
}

TEST(SettingsTrial, OfOthersDuringATrialGoesBackToWhatWasKeptBefore) {
  SettingsTrial trial(Settings{.theme = "light"});
  trial.Try(0, Settings{.theme = "dark"}, 20 * kSecond);
  trial.Try(10 * kSecond, Settings{.theme = "contrast"}, 20 * kSecond);
  EXPECT_EQ(trial.SecondsLeft(10 * kSecond), 20);
  EXPECT_TRUE(trial.GiveUp());
  EXPECT_FALSE(trial.GiveUp());
  EXPECT_EQ(trial.current().theme, "light");
}

TEST(SettingsTrial, LastsLongEnoughForASlowScanner) {
  Settings settings{.access = "one_switch"};
  EXPECT_EQ(TrialLength_us(settings, 20 * kSecond), 20 * kSecond);
  settings.scan.scan_time_s = 10;
  EXPECT_GE(TrialLength_us(settings, 20 * kSecond), 80 * kSecond);
  settings.access = "pointer";
  EXPECT_EQ(TrialLength_us(settings, 20 * kSecond), 20 * kSecond);
}

}  // namespace
}  // namespace beckon::ui_bridge::web
