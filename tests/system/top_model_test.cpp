// From STATUS messages to the rows of `beckon top`.
#include "tools/beckon/top_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/base/status_counters.h"

namespace beckon::tool {
namespace {

using ::testing::ElementsAre;

constexpr Utime kBegun = 1'700'000'000 * kSecond;

msg::Status Say(const std::string& service, Utime after, std::vector<msg::Counter> counters = {},
                int pid = 7, const std::string& host = "desk") {
  msg::Status status;
  status.utime = kBegun + after;
  status.service = service;
  status.host = host;
  status.pid = pid;
  status.started_utime = kBegun;
  status.build = "0.1.0";
  status.state = "well";
  status.counters = std::move(counters);
  return status;
}

std::vector<std::string> Services(const TopModel& model, Utime now,
                                  TopSort sort = TopSort::kService) {
  std::vector<std::string> names;
  for (const auto& row : model.Rows(now, sort)) names.push_back(row.service);
  return names;
}

TEST(TopModel, TellsRatesBetweenTheLastTwoStatuses) {
  TopModel model;
  model.OnStatus(Say("perception", kSecond, {{"sent.BECKON_SCENE", 10}, {"dropped", 4}}), kSecond);
  auto row = model.Rows(kSecond, TopSort::kService).at(0);
  EXPECT_FALSE(row.frames_per_s);
  EXPECT_FALSE(row.drops_per_s);
  model.OnStatus(
      Say("perception", 3 * kSecond, {{"sent.BECKON_SCENE", 70}, {"dropped", 5}, {"lost", 3}}),
      3 * kSecond);
  row = model.Rows(3 * kSecond, TopSort::kService).at(0);
  EXPECT_DOUBLE_EQ(row.frames_per_s.value(), 30);
  EXPECT_DOUBLE_EQ(row.drops_per_s.value(), 0.5);
  EXPECT_EQ(row.drops, 8);
}

TEST(TopModel, ReadsWhatEveryProcessTells) {
  BusTraffic traffic;
  traffic["BECKON_SCENE"] = {.received = 30,
                             .refused = {{"malformed", 2}},
                             .age_us_max = 40'000,
                             .wait_us_max = 300,
                             .newest_seq = 30};
  traffic["BECKON_POSES"] = {.sent = 15, .refused = {{"malformed", 1}, {"stale", 9}}};
  TopModel model;
  model.OnStatus(Say("pose", kSecond,
                     StatusCounters(0).Take(traffic, {.cpu_ms = 420, .rss_kb = 9000}, kSecond)),
                 0);
  const auto row = model.Rows(0, TopSort::kService).at(0);
  EXPECT_EQ(row.cpu_percent, 42);
  EXPECT_EQ(row.rss_kb, 9000);
  EXPECT_EQ(row.in_per_s, 30);
  EXPECT_EQ(row.out_per_s, 15);
  EXPECT_EQ(row.age_us, 40'000);
  EXPECT_EQ(row.uptime_s, 1);
  ASSERT_EQ(row.refused.size(), 2u);
  EXPECT_EQ(row.refused[0].reason, "stale");
  EXPECT_EQ(row.refused[1].total, 3) << "over both channels";
}

TEST(TopModel, MarksWhoFellSilentAndForgetsThemLater) {
  TopModel model;
  model.OnStatus(Say("pose", 0), kSecond);
  EXPECT_FALSE(model.Rows(2 * kSecond, TopSort::kService).at(0).silent);
  const auto row = model.Rows(kSecond + TopModel::kSilent_us + 1, TopSort::kService).at(0);
  EXPECT_TRUE(row.silent);
  EXPECT_TRUE(model.Rows(2 * kSecond + TopModel::kForgotten_us, TopSort::kService).empty());
  model.OnStatus(Say("pose", 900 * kSecond), 900 * kSecond);
  EXPECT_FALSE(model.Rows(900 * kSecond, TopSort::kService).at(0).silent) << "back again";
}

TEST(TopModel, ShowsAProcessThatWasStartedAgainOnce) {
  TopModel model;
  model.OnStatus(Say("pose", 0, {}, 7), kSecond);
  msg::Status again = Say("pose", 5 * kSecond, {}, 8);
  again.started_utime += 4 * kSecond;
  model.OnStatus(again, 5 * kSecond);
  const auto rows = model.Rows(5 * kSecond, TopSort::kService);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].pid, 8);
}

TEST(TopModel, ShowsTwoOfOneServiceThatBothLive) {
  TopModel model;
  for (Utime now = 0; now < 5 * kSecond; now += kSecond) {
    model.OnStatus(Say("pose", now, {}, 7), now + 1);
    msg::Status other = Say("pose", now, {}, 8);
    other.started_utime += 1;
    model.OnStatus(other, now + 2);
    model.OnStatus(Say("pose", now, {}, 7, "arm"), now + 3);
  }
  EXPECT_EQ(model.Rows(5 * kSecond, TopSort::kService).size(), 3u);
}

TEST(TopModel, LeavesOutLateCopies) {
  TopModel model;
  model.OnStatus(Say("capture", kSecond, {{"sent.BECKON_FRAME", 30}}), 0);
  model.OnStatus(Say("capture", 2 * kSecond, {{"sent.BECKON_FRAME", 60}}), 1);
  model.OnStatus(Say("capture", kSecond, {{"sent.BECKON_FRAME", 30}}), 2);
  EXPECT_DOUBLE_EQ(model.Rows(2, TopSort::kService).at(0).frames_per_s.value(), 30);
}

TEST(TopModel, SortsAlongTheDataAndByWhatIsAskedFor) {
  TopModel model;
  model.OnStatus(Say("ui_bridge", 0, {{"cpu_percent", 5}, {"rss_kb", 10}}), 0);
  model.OnStatus(Say("recorder", 0, {{"cpu_percent", 50}}), 0);
  model.OnStatus(Say("capture", 0, {{"cpu_percent", 20}, {"rss_kb", 90}}, 7, "arm"), 0);
  EXPECT_THAT(Services(model, 0), ElementsAre("capture", "ui_bridge", "recorder"));
  EXPECT_THAT(Services(model, 0, TopSort::kCpu), ElementsAre("recorder", "capture", "ui_bridge"));
  EXPECT_THAT(Services(model, 0, TopSort::kMemory),
              ElementsAre("capture", "ui_bridge", "recorder"));
  EXPECT_THAT(Services(model, 0, TopSort::kHost), ElementsAre("capture", "ui_bridge", "recorder"));
}

TEST(TopModel, EachSortHasItsKey) {
  for (char key : std::string("shcmiadr")) EXPECT_TRUE(SortOfKey(key)) << key;
  EXPECT_FALSE(SortOfKey('q'));
  EXPECT_FALSE(SortOfKey('\x1b'));
}

TEST(TopModel, IsBoundedOnABusOfStrangers) {
  TopModel model;
  for (int pid = 0; pid < 5000; ++pid) model.OnStatus(Say("stranger", 0, {}, pid), 0);
  EXPECT_LE(model.Rows(0, TopSort::kService).size(), 256u);
}

TEST(TopModel, TakesNonsenseFromStrangers) {
  TopModel model;
  for (const int64_t value : {INT64_MIN, INT64_MAX, int64_t{-1}}) {
    msg::Status status = Say("stranger", 1 + (value & 1), {});
    for (const char* name : {"sent.BECKON_FRAME", "dropped", "lost", "age_us.X", "refused.X.y",
                             "refused.", "uptime_s", "cpu_percent", "rss_kb", "received_per_s"})
      status.counters.push_back({name, value});
    status.started_utime = value;
    model.OnStatus(status, 1);
    EXPECT_EQ(model.Rows(2, TopSort::kRefused).size(), 1u);
  }
}

}  // namespace
}  // namespace beckon::tool
