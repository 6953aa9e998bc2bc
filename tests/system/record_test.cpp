// `beckon record` and `beckon replay` with LCM's own programs, through deaths of either.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/system/live_system.h"
#include "tests/system/written_log.h"

namespace beckon::system_test {
namespace {

using ::testing::HasSubstr;
using tool::Supervisor;

namespace fs = std::filesystem;

msg::Session Event(msg::SessionKind kind, const std::string& id) {
  msg::Session event;
  event.utime = SystemClock().Now();
  event.session_id = id;
  event.user = "ann";
  event.kind = kind;
  return event;
}

class RecordTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!BusObstacle().empty()) GTEST_SKIP() << BusObstacle();
    if (std::system("command -v lcm-logger > /dev/null") != 0) GTEST_SKIP() << "no lcm-logger";
  }

  std::string log() const { return system_.run_dir() + "/bus.lcm"; }
  std::string index_file() const { return log() + ".index.json"; }
  nlohmann::json Index() const {
    return nlohmann::json::parse(tool::ReadFile(index_file()), nullptr, false);
  }
  static Output Beckon(std::vector<std::string> args) {
    args.insert(args.end(), {"--lcm-url", LcmUrl()});
    return RunProgram(BECKON_BIN_DIR "/beckon", args);
  }
  void StartRecorder() {
    tool::ProcessSpec spec;
    spec.name = "recorder";
    spec.program = BECKON_BIN_DIR "/beckon";
    spec.args = {"record", "--out", log(), "--lcm-url", LcmUrl()};
    spec.log_file = system_.run_dir() + "/recorder.log";
    system_.Start(spec, Supervisor::Restart::kNever);
  }
  void Say(msg::SessionKind kind, const std::string& id) {
    const auto sent = system_.bus().Publish(Event(kind, id));
    ASSERT_TRUE(sent.ok()) << sent.error().message;
  }
  /// Records two sessions, until the index knows of both.
  void RecordTwoSessions() {
    StartRecorder();
    ASSERT_TRUE(system_.RunUntil([&] {
      Say(msg::SessionKind::kBegun, "first");
      return Sessions() == 1;
    })) << system_.Logs();
    Say(msg::SessionKind::kAbandoned, "first");
    ASSERT_TRUE(system_.RunUntil([&] {
      Say(msg::SessionKind::kBegun, "second");
      return Sessions() == 2;
    })) << system_.Logs();
  }
  size_t Sessions() const {
    const auto index = Index();
    return index.is_object() ? index["sessions"].size() : 0;
  }

  LiveSystem system_;
};

TEST_F(RecordTest, KeepsAnIndexWhileItRecordsAndFinishesItOnCtrlC) {
  RecordTwoSessions();
  const auto* status = system_.watch().StatusOf("recorder");
  ASSERT_TRUE(system_.RunUntil([&] {
    return (status = system_.watch().StatusOf("recorder")) &&
           status->state.find("2 sessions") != std::string::npos;
  })) << system_.watch().Says("recorder");
  Say(msg::SessionKind::kAbandoned, "second");
  system_.supervisor().Signal("recorder", SIGINT);
  ASSERT_TRUE(system_.RunUntil([&] { return !system_.deaths().empty(); }));
  EXPECT_EQ(system_.deaths()[0].exit.code, 0) << system_.Logs();
  const auto index = Index();
  ASSERT_TRUE(index.is_object());
  EXPECT_EQ(index["log_bytes"], fs::file_size(log()));
  EXPECT_EQ(index["sessions"][0]["id"], "first");
  EXPECT_EQ(index["sessions"][0]["outcome"], "abandoned");
  EXPECT_EQ(index["processes"][0]["service"], "recorder");
  EXPECT_GE(index["channels"]["BECKON_SESSION"]["messages"], 3);
}

TEST_F(RecordTest, LeavesALogThatIsListedAfterItWasKilled) {
  RecordTwoSessions();
  system_.supervisor().Signal("recorder", SIGKILL);
  ASSERT_TRUE(system_.RunUntil([&] { return !system_.deaths().empty(); }));
  EXPECT_EQ(system_.deaths()[0].exit.signal, SIGKILL);
  fs::remove(index_file());
  const auto listed = Beckon({"replay", log(), "--list"});
  EXPECT_EQ(listed.code, 0) << listed.text;
  EXPECT_THAT(listed.text, HasSubstr("first"));
  EXPECT_THAT(listed.text, HasSubstr("abandoned"));
  EXPECT_THAT(listed.text, HasSubstr("BECKON_SESSION"));
  EXPECT_EQ(Sessions(), 2u) << "the index is written anew";
}

TEST_F(RecordTest, SaysWhyWhenTheLoggerEnds) {
  StartRecorder();
  ASSERT_TRUE(system_.RunUntil([&] {
    Say(msg::SessionKind::kBegun, "first");
    return Sessions() == 1;
  })) << system_.Logs();
  const auto recorder = system_.supervisor().Pid("recorder");
  ASSERT_TRUE(recorder);
  // Its only child.
  const std::string pid = std::to_string(*recorder);
  const pid_t logger =
      std::atoi(tool::ReadFile("/proc/" + pid + "/task/" + pid + "/children").c_str());
  ASSERT_GT(logger, 0);
  ASSERT_EQ(kill(logger, SIGKILL), 0);
  ASSERT_TRUE(system_.RunUntil([&] { return !system_.deaths().empty(); }));
  EXPECT_EQ(system_.deaths()[0].exit.code, 1);
  EXPECT_THAT(system_.Logs(), HasSubstr("lcm-logger ended (killed by signal 9"));
  EXPECT_EQ(Sessions(), 1u);
}

/// A log of two sessions, a second apart, that needs no recorder.
class ReplayTest : public RecordTest {
 protected:
  void SetUp() override {
    RecordTest::SetUp();
    if (IsSkipped()) return;
    tool::WrittenLog written(log());
    Utime now = 1'700'000'000 * kSecond;
    for (const char* id : {"first", "second"}) {
      written.Add(now, Event(msg::SessionKind::kBegun, id));
      written.Add(now + 1000, Event(msg::SessionKind::kAbandoned, id));
      now += kSecond;
    }
    system_.bus().Subscribe<msg::Session>([this](const msg::Session& event) {
      heard_.insert(event.session_id);
      if (event.kind == msg::SessionKind::kAbandoned) ++ends_;
    });
  }

  /// The sessions that `beckon replay` lets the bus hear.
  std::set<std::string> Replayed(std::vector<std::string> args, int ends) {
    args.insert(args.begin(), {"replay", log()});
    args.insert(args.end(), {"--lcm-url", LcmUrl()});
    tool::ProcessSpec spec;
    spec.name = "player";
    spec.program = BECKON_BIN_DIR "/beckon";
    spec.args = args;
    spec.log_file = system_.run_dir() + "/player.log";
    system_.Start(spec, Supervisor::Restart::kNever);
    EXPECT_TRUE(system_.RunUntil([&] { return ends_ >= ends && !system_.deaths().empty(); }))
        << system_.Logs();
    return heard_;
  }

  std::set<std::string> heard_;
  int ends_ = 0;
};

TEST_F(ReplayTest, PlaysAllOfIt) {
  EXPECT_EQ(Replayed({}, 2), (std::set<std::string>{"first", "second"}));
}

TEST_F(ReplayTest, PlaysOnlyTheSessionAskedForByNumber) {
  EXPECT_EQ(Replayed({"--session", "2"}, 1), std::set<std::string>{"second"});
}

TEST_F(ReplayTest, PlaysOnlyTheSessionAskedForById) {
  EXPECT_EQ(Replayed({"--session", "first"}, 1), std::set<std::string>{"first"});
}

TEST_F(ReplayTest, PlaysOnlyTheSecondsAskedFor) {
  EXPECT_EQ(Replayed({"--from", "0.5", "--to", "2"}, 1), std::set<std::string>{"second"});
}

TEST_F(ReplayTest, ListsWhatIsWholeOfACutLogAndSaysWhereItEnds) {
  const std::string whole = tool::ReadFile(log());
  tool::WriteFile(log(), whole.substr(0, whole.size() - 10));
  const auto listed = Beckon({"replay", log(), "--list"});
  EXPECT_EQ(listed.code, 0) << listed.text;
  EXPECT_THAT(listed.text, HasSubstr("first"));
  EXPECT_THAT(listed.text, HasSubstr("second"));
  EXPECT_THAT(listed.text, HasSubstr("ends amid a message"));
}

TEST_F(ReplayTest, SaysWhatIsWrongWithWhatIsAskedFor) {
  auto output = Beckon({"replay", log(), "--session", "3"});
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.text, HasSubstr("not one of the 2 sessions"));
  output = Beckon({"replay", log(), "--from", "1000"});
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.text, HasSubstr("no message"));
  output = Beckon({"replay", BECKON_SOURCE_DIR "/LICENSE", "--list"});
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.text, HasSubstr("is no LCM log"));
  output = Beckon({"replay", log(), "--hash"});
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.text, HasSubstr("not part of this version"));
  output = Beckon({"record", "--out", log()});
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.text, HasSubstr("exists already"));
}

}  // namespace
}  // namespace beckon::system_test
