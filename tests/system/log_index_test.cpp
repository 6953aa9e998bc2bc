// What is found in logs: whole ones, cut ones, damaged ones, ones that grow.
#include "tools/beckon/log_index.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/system/written_log.h"
#include "tools/beckon/log_follower.h"
#include "tools/beckon/log_index_text.h"
#include "tools/beckon/log_slice.h"
#include "tools/beckon/run_folder.h"

namespace beckon::tool {
namespace {

using ::testing::HasSubstr;

constexpr Utime kStart = 1'700'000'000 * kSecond;

msg::Session Event(msg::SessionKind kind, const std::string& id, const std::string& text = {}) {
  msg::Session event;
  event.utime = 1;
  event.session_id = id;
  event.user = "ann";
  event.device = kind < msg::SessionKind::kIdle ? "switch-1" : "";
  event.kind = kind;
  event.text = text;
  return event;
}

msg::Query Ask(const std::string& id, int64_t number) {
  msg::Query query;
  query.utime = 1;
  query.id = number;
  query.session_id = id;
  query.user = "ann";
  query.text = "open the carton?";
  query.any_action = false;
  query.actions = {"Open"};
  query.any_object = false;
  query.objects = {{4, "Carton", 1}};
  query.options = {{.text = "Yes"}, {.text = "No"}};
  query.scene_seq = 1;
  query.n_candidates = 2;
  query.expected_questions = 1;
  query.expected_seconds = 4;
  query.best_posterior = 0.5;
  return query;
}

msg::Task Open(const std::string& id) {
  msg::Task task;
  task.utime = 1;
  task.task_id = id;
  task.user = "ann";
  task.action = "Open";
  task.object = {4, "Carton", 1};
  task.pose.object_id = 4;
  task.posterior = 0.995;
  task.expires_utime = 100;
  return task;
}

msg::TaskStatus Robot(const std::string& id, msg::TaskState state) {
  msg::TaskStatus status;
  status.utime = 1;
  status.task_id = id;
  status.state = state;
  return status;
}

msg::Status Process(const std::string& service, int pid) {
  msg::Status status;
  status.utime = 1;
  status.service = service;
  status.host = "desk";
  status.pid = pid;
  status.build = "0.1.0";
  return status;
}

class LogIndexTest : public ::testing::Test {
 protected:
  std::string path() const { return folder_->path() + "/log"; }

  /// Two conversations: one confirmed after two questions, and one given up.
  void WriteTwoSessions() {
    using enum msg::SessionKind;
    WrittenLog log(path());
    Utime now = kStart;
    const auto add = [&](const auto& message) { log.Add(now += kSecond, message); };
    add(Process("intention", 7));
    add(Event(kRequestStart, "first"));
    add(Event(kRequestStart, "first"));
    for (int64_t id : {1, 1, 2}) add(Ask("first", id));
    add(Open("first"));
    add(Event(kConfirmed, "first"));
    add(Robot("first", msg::TaskState::kAccepted));
    add(Robot("first", msg::TaskState::kDone));
    for (int i = 0; i < 3; ++i) add(Event(kConfirmed, "first"));
    add(Event(kBegun, "second"));
    add(Ask("second", 3));
    add(Event(kAbandoned, "second", "cancelled"));
    add(Process("intention", 7));
    log.AddBytes(now += kSecond, "OTHER", {1, 2, 3});
  }

  LogIndex Index() const {
    auto follower = LogFollower::Open(path());
    EXPECT_TRUE(follower.ok());
    follower->Read();
    return follower->index();
  }

  Result<RunFolder> folder_ = RunFolder::Make("", "beckon-log-test");
};

TEST_F(LogIndexTest, TellsConversationsFromTheirRequestToTheRobotsAnswer) {
  WriteTwoSessions();
  const LogIndex index = Index();
  EXPECT_EQ(index.refused, 0);
  ASSERT_EQ(index.sessions.size(), 2u);
  const auto& first = index.sessions[0];
  EXPECT_EQ(first.id, "first");
  EXPECT_EQ(first.user, "ann");
  EXPECT_EQ(first.begin, kStart + 2 * kSecond);
  EXPECT_EQ(first.end, kStart + 10 * kSecond);
  EXPECT_EQ(first.questions, 2);
  EXPECT_EQ(first.outcome, "confirmed");
  EXPECT_EQ(first.task, "Open Carton 1");
  EXPECT_EQ(first.detail, "done");
  const auto& second = index.sessions[1];
  EXPECT_EQ(second.outcome, "abandoned");
  EXPECT_EQ(second.detail, "cancelled");
  EXPECT_EQ(second.questions, 1);
  EXPECT_GE(second.offset, first.end_offset);
}

TEST_F(LogIndexTest, TellsProcessesAndEveryChannel) {
  WriteTwoSessions();
  const LogIndex index = Index();
  ASSERT_EQ(index.processes.size(), 1u);
  const auto& process = index.processes.at({"desk", "intention", 7});
  EXPECT_EQ(process.build, "0.1.0");
  EXPECT_EQ(process.last - process.first, 16 * kSecond);
  EXPECT_EQ(index.channels.at("OTHER").bytes, 3);
  int64_t messages = 0;
  for (const auto& [name, channel] : index.channels) messages += channel.messages;
  EXPECT_EQ(messages, index.messages);
  EXPECT_EQ(index.bytes, static_cast<int64_t>(std::filesystem::file_size(path())));
}

TEST_F(LogIndexTest, EndsEveryConversationByAStop) {
  {
    WrittenLog log(path());
    log.Add(kStart, Event(msg::SessionKind::kBegun, "first"));
    log.Add(kStart + 1, Event(msg::SessionKind::kRequestStop, ""));
    log.Add(kStart + 2, Event(msg::SessionKind::kBegun, "first"));
  }
  const LogIndex index = Index();
  ASSERT_EQ(index.sessions.size(), 1u);
  EXPECT_EQ(index.sessions[0].outcome, "stopped");
  EXPECT_EQ(index.sessions[0].end, kStart + 1);
}

TEST_F(LogIndexTest, FindsSessionsByNumberIdAndBeginningOfAnId) {
  WriteTwoSessions();
  const LogIndex index = Index();
  ASSERT_NE(index.Find("2"), nullptr);
  EXPECT_EQ(index.Find("2")->id, "second");
  EXPECT_EQ(index.Find("second"), index.Find("2"));
  EXPECT_EQ(index.Find("fi"), index.Find("1"));
  EXPECT_EQ(index.Find("3"), nullptr);
  EXPECT_EQ(index.Find(""), nullptr);
}

TEST_F(LogIndexTest, CountsWhatItCannotRead) {
  {
    WrittenLog log(path());
    log.AddBytes(kStart, "BECKON_SESSION", {1, 2, 3});
    log.Add(kStart, Event(msg::SessionKind::kBegun, "first"));
  }
  const LogIndex index = Index();
  EXPECT_EQ(index.refused, 1);
  EXPECT_EQ(index.sessions.size(), 1u);
}

TEST_F(LogIndexTest, ListsWhatIsWholeOfALogCutAnywhere) {
  WriteTwoSessions();
  const std::string whole = ReadFile(path());
  int64_t last = -1;
  for (size_t size = 0; size <= whole.size(); size += 7) {
    WriteFile(path(), whole.substr(0, size));
    auto follower = LogFollower::Open(path());
    ASSERT_TRUE(follower.ok());
    follower->Read();
    const LogIndex& index = follower->index();
    ASSERT_GE(index.messages, last);
    last = index.messages;
    if (index.bytes < static_cast<int64_t>(size)) {
      ASSERT_THAT(follower->Damage(), HasSubstr("byte " + std::to_string(index.bytes)));
    } else {
      ASSERT_EQ(follower->Damage(), "");
    }
  }
  EXPECT_GE(last, 17);
}

TEST_F(LogIndexTest, FollowsALogThatGrowsInPieces) {
  WriteTwoSessions();
  const std::string whole = ReadFile(path());
  const std::string all = IndexJson(Index(), "log");
  WriteFile(path(), "");
  auto follower = LogFollower::Open(path());
  ASSERT_TRUE(follower.ok());
  for (size_t at = 0; at < whole.size(); at += 100) {
    std::ofstream(path(), std::ios::binary | std::ios::app) << whole.substr(at, 100);
    follower->Read();
  }
  EXPECT_EQ(IndexJson(follower->index(), "log"), all);
  EXPECT_EQ(follower->Damage(), "");
}

TEST_F(LogIndexTest, GoesOnBehindDamage) {
  WriteTwoSessions();
  std::string bytes = ReadFile(path());
  const auto& first = Index().sessions[0];
  for (int64_t at = first.offset; at < first.offset + 40; ++at)
    bytes[static_cast<size_t>(at)] = 'x';
  WriteFile(path(), bytes);
  auto follower = LogFollower::Open(path());
  ASSERT_TRUE(follower.ok());
  follower->Read();
  EXPECT_THAT(follower->Damage(), HasSubstr("belong to no message"));
  EXPECT_EQ(follower->index().sessions.size(), 2u);
}

/// Sound: bounded, consistent, and printable whatever the bytes are.
void ExpectSound(const std::string& path) {
  auto follower = LogFollower::Open(path);
  ASSERT_TRUE(follower.ok());
  follower->Read();
  const LogIndex& index = follower->index();
  const auto size = static_cast<int64_t>(std::filesystem::file_size(path));
  ASSERT_LE(index.bytes, size);
  ASSERT_LE(index.messages * 29, size);
  int64_t messages = 0, bytes = 0;
  for (const auto& [name, channel] : index.channels) {
    messages += channel.messages;
    bytes += channel.bytes;
  }
  ASSERT_EQ(messages, index.messages);
  ASSERT_LE(bytes, size);
  for (const auto& session : index.sessions) {
    ASSERT_GE(session.offset, 0);
    ASSERT_LT(session.offset, session.end_offset);
    ASSERT_LE(session.end_offset, size);
  }
  ASSERT_FALSE(RenderIndex(index).empty());
  const auto json = nlohmann::json::parse(IndexJson(index, "log"), nullptr, false);
  ASSERT_FALSE(json.is_discarded());
}

TEST_F(LogIndexTest, IsSoundForMutatedLogs) {
  WriteTwoSessions();
  const std::string whole = ReadFile(path());
  for (unsigned round = 0; round < 500; ++round) {
    std::mt19937 random(round);
    std::string bytes = whole;
    for (unsigned changes = 1 + random() % 8; changes > 0 && !bytes.empty(); --changes) {
      const size_t at = random() % bytes.size();
      switch (random() % 5) {
        case 0:
          bytes[at] = static_cast<char>(random());
          break;
        case 1:  // a length, or a time, of ones
          for (size_t i = at; i < std::min(at + 4, bytes.size()); ++i) bytes[i] = '\xff';
          break;
        case 2:
          bytes.erase(at, random() % 60);
          break;
        case 3:
          bytes.insert(at, bytes.substr(random() % bytes.size(), random() % 200));
          break;
        default:
          bytes.resize(at + 1);
      }
    }
    WriteFile(path(), bytes);
    ASSERT_NO_FATAL_FAILURE(ExpectSound(path())) << "round " << round;
  }
}

TEST_F(LogIndexTest, IsSoundForRecordsOfAnyLength) {
  for (unsigned round = 0; round < 500; ++round) {
    std::mt19937 random(round);
    std::string bytes;
    for (int record = 0; record < 6; ++record) {
      bytes += "\xed\xa1\xda\x01";
      for (int i = 0; i < 24; ++i)
        bytes += static_cast<char>(random() % 3 == 0 ? random() : random() % 2 * 0xff);
      bytes += std::string(random() % 80, static_cast<char>(random()));
    }
    WriteFile(path(), bytes);
    ASSERT_NO_FATAL_FAILURE(ExpectSound(path())) << "round " << round;
  }
}

TEST_F(LogIndexTest, WritesAnIndexForPrograms) {
  WriteTwoSessions();
  auto follower = LogFollower::Open(path());
  ASSERT_TRUE(follower.ok());
  follower->Read();
  ASSERT_TRUE(follower->WriteIndex().ok());
  const auto json = nlohmann::json::parse(ReadFile(path() + ".index.json"));
  EXPECT_EQ(json["log"], "log");
  EXPECT_EQ(json["sessions"][0]["task"], "Open Carton 1");
  EXPECT_EQ(json["sessions"][1]["outcome"], "abandoned");
  EXPECT_EQ(json["processes"][0]["service"], "intention");
  EXPECT_EQ(json["channels"]["OTHER"]["messages"], 1);
}

TEST_F(LogIndexTest, SlicesASessionIntoALogOfItsOwn) {
  WriteTwoSessions();
  const LogIndex all = Index();
  const auto& first = all.sessions[0];
  LogRange range;
  range.offset = first.offset;
  range.end_offset = first.end_offset;
  const auto slice = SliceLog(path(), range);
  ASSERT_TRUE(slice.ok()) << slice.error().message;
  EXPECT_EQ(ReadFile(*slice).size(), static_cast<size_t>(first.end_offset - first.offset));
  auto follower = LogFollower::Open(*slice);
  ASSERT_TRUE(follower.ok());
  follower->Read();
  ASSERT_EQ(follower->index().sessions.size(), 1u);
  EXPECT_EQ(follower->index().sessions[0].begin, first.begin);
  EXPECT_EQ(follower->index().sessions[0].detail, "done");
}

TEST_F(LogIndexTest, SlicesByTimeAndRefusesAnEmptyPart) {
  WriteTwoSessions();
  const auto slice = SliceLog(path(), {.begin = kStart + 3 * kSecond, .end = kStart + 6 * kSecond});
  ASSERT_TRUE(slice.ok()) << slice.error().message;
  auto follower = LogFollower::Open(*slice);
  follower->Read();
  EXPECT_EQ(follower->index().messages, 3);
  const auto nothing = SliceLog(path(), {.begin = kStart + 900 * kSecond});
  ASSERT_FALSE(nothing.ok());
  EXPECT_THAT(nothing.error().message, HasSubstr("no message"));
}

TEST_F(LogIndexTest, SaysWhatIsWrongWithAFile) {
  const auto missing = LogReader::Open(path() + "-not-there");
  ASSERT_FALSE(missing.ok());
  EXPECT_THAT(missing.error().message, HasSubstr("No such file"));
  EXPECT_FALSE(LogReader::Open(folder_->path()).ok());
}

}  // namespace
}  // namespace beckon::tool
