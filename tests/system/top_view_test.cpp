// What `beckon top` draws.
#include "tools/beckon/top_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tools/beckon/text_table.h"
#include "tools/beckon/top_json.h"

namespace beckon::tool {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

TopRow Row(const std::string& service) {
  TopRow row;
  row.service = service;
  row.host = "a-host-with-a-long-name.lab.example";
  row.pid = 7;
  row.state = "showing the embedded scene, which has a rather long name for a line of 80 letters";
  row.uptime_s = 86'000;
  row.cpu_percent = 100;
  row.rss_kb = 999'999;
  row.in_per_s = 12'345;
  row.out_per_s = 3;
  row.frames_per_s = 29.97;
  row.drops_per_s = 0.5;
  row.age_us = 123'456;
  row.handler_us = 5;
  row.refused_per_s = 2;
  row.refused = {{"stale", 1200, 2}, {"malformed", 1, 0}};
  return row;
}

TopTalks Talks() {
  TopTalks talks;
  talks.talks = {{.user = "ann",
                  .state = "asked",
                  .text = "open the carton?",
                  .kind = "full",
                  .questions = 2,
                  .since_us = 4 * kSecond}};
  talks.last_task = TopTask{"ann", "Open Carton 1", "done", 60 * kSecond};
  return talks;
}

TEST(TopView, FitsAnyTerminal) {
  std::vector<TopRow> rows;
  for (int i = 0; i < 30; ++i) rows.push_back(Row("service" + std::to_string(i)));
  rows[3].silent = true;
  TopTalks talks = Talks();
  talks.stopped = true;
  for (size_t columns : {1, 10, 40, 80, 200}) {
    for (size_t height : {1, 2, 5, 24, 60, 100}) {
      const auto lines = DrawTop(rows, talks, {.columns = columns, .rows = height});
      EXPECT_LE(lines.size(), height);
      for (const auto& line : lines) EXPECT_LE(TextWidth(line), columns) << line;
    }
  }
}

TEST(TopView, ShowsSixProcessesAndTheConversationOn80x24) {
  const std::vector<TopRow> rows(6, Row("perception"));
  const auto lines = DrawTop(rows, Talks(), {.columns = 80, .rows = 24});
  EXPECT_EQ(lines.size(), 2u + 12 + 1 + 2);
  EXPECT_EQ(lines[1],
            "SERVICE      HOST           UP CPU%   MEM  IN/s OUT/s   FPS DROP/s    AGE REF/s");
  EXPECT_EQ(lines[2],
            "perception   a-host-wi…  23.9h  100  1.0G   12k     3  30.0    0.5  123ms   2.0");
  EXPECT_THAT(lines, Contains("ann: question 3 (full) \"open the carton?\", for 4.0s"));
  EXPECT_THAT(lines, Contains("last task: Open Carton 1 for ann, done, 60.0s ago"));
}

TEST(TopView, NamesWhyMessagesWereRefused) {
  const auto lines = DrawTop({Row("intention")}, {}, {.columns = 200});
  EXPECT_THAT(lines, Contains(HasSubstr("refused 1.2k stale (2.0/s), 1 malformed")));
}

TEST(TopView, LeavesOutFirstStatesThenProcessesWhereThereIsNoRoom) {
  const std::vector<TopRow> rows(6, Row("pose"));
  auto lines = DrawTop(rows, {}, {.columns = 80, .rows = 9});
  EXPECT_EQ(lines.size(), 8u);
  EXPECT_THAT(lines, Not(Contains(HasSubstr("showing"))));
  lines = DrawTop(rows, {}, {.columns = 80, .rows = 6});
  EXPECT_EQ(lines.back(), "  and 3 more, on a taller terminal");
}

TEST(TopView, MarksSilenceAndStopInWordsAndInRed) {
  TopRow row = Row("pose");
  row.silent = true;
  row.heard_us = 12 * kSecond;
  TopTalks talks;
  talks.stopped = true;
  auto lines = DrawTop({row}, talks, {.columns = 80});
  EXPECT_THAT(lines, Contains(HasSubstr("silent for 12.0s")));
  EXPECT_THAT(lines, Contains(HasSubstr("STOPPED")));
  for (const auto& line : lines) EXPECT_EQ(line.find('\x1b'), std::string::npos);
  lines = DrawTop({row}, talks, {.columns = 80, .colour = true});
  EXPECT_THAT(lines, Contains(HasSubstr("\x1b[31m")));
  EXPECT_THAT(lines, Contains(HasSubstr("\x1b[1;37;41m STOPPED")));
}

TEST(TopView, LetsNobodyOnTheBusSteerTheTerminal) {
  TopRow row = Row("ev\x1b[2Jil");
  row.host = "\xc2\x9b\x31mhost";
  row.state = "\x07 \xff bell";
  TopTalks talks;
  talks.talks = {{.user = "\x1b]0;x\x07", .state = "asked", .text = "\r\n"}};
  std::string text;
  for (const auto& line : DrawTop({row}, talks, {.columns = 300})) text += line;
  for (const char* bad : {"\x1b", "\x07", "\r", "\xc2\x9b", "\xff"})
    EXPECT_EQ(text.find(bad), std::string::npos);
}

TEST(TopView, WritesShortNumbers) {
  EXPECT_EQ(ShortCount(0), "0");
  EXPECT_EQ(ShortCount(999), "999");
  EXPECT_EQ(ShortCount(9'540), "9.5k");
  EXPECT_EQ(ShortCount(12'000'000), "12M");
  EXPECT_EQ(ShortTime(400), "0.4ms");
  EXPECT_EQ(ShortTime(12'000), "12ms");
  EXPECT_EQ(ShortTime(1'200'000), "1.2s");
  EXPECT_EQ(ShortTime(180 * kSecond), "3min");
  EXPECT_EQ(ShortTime(7560 * kSecond), "2.1h");
  for (int64_t n : {INT64_MIN, INT64_MAX}) {
    EXPECT_LE(ShortCount(n).size(), 22u);
    EXPECT_LE(ShortTime(n).size(), 22u);
  }
}

TEST(TopJson, IsOneLineThatHoldsTheTable) {
  TopRow bare;
  bare.service = "old";
  const std::string text = TopJson({Row("pose"), bare}, Talks());
  EXPECT_EQ(text.find('\n'), std::string::npos);
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json["processes"][0]["service"], "pose");
  EXPECT_EQ(json["processes"][0]["refused"]["stale"]["total"], 1200);
  EXPECT_TRUE(json["processes"][1]["age_us"].is_null());
  EXPECT_EQ(json["talks"][0]["text"], "open the carton?");
  EXPECT_EQ(json["last_task"]["state"], "done");
  EXPECT_EQ(json["stopped"], false);
}

TEST(TextTable, CutsAndFillsByCharacters) {
  EXPECT_EQ(Fit("größer", 8), "größer  ");
  EXPECT_EQ(Fit("größer", 8, true), "  größer");
  EXPECT_EQ(Fit("größer", 4), "grö…");
  EXPECT_EQ(Fit("a", 0), "");
}

TEST(TextTable, LinesUpColumns) {
  TextTable table({{"N"}, {"WORD", false}});
  EXPECT_THAT(table.Render(), HasSubstr("(none)"));
  table.Add({"1", "größer"});
  table.Add({"10", "a"});
  EXPECT_EQ(table.Render(), " N  WORD\n 1  größer\n10  a\n");
}

}  // namespace
}  // namespace beckon::tool
