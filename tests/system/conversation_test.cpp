// Whole conversations between the five real processes: from an image to a remembered task, through
// deaths, garbage and replay.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <nlohmann/json.hpp>
#include <random>

#include "lcmtypes/codec.h"
#include "services/base/cloud_file.h"
#include "tests/system/live_system.h"
#include "tools/beckon/session_report.h"

namespace beckon::system_test {
namespace {

class SystemTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!Obstacle().empty()) GTEST_SKIP() << Obstacle();
  }

  /// Sessions as `beckon demo --headless` prints them.
  static std::vector<nlohmann::json> Demo(std::vector<std::string> args) {
    args.insert(args.begin(), {"demo", "--headless", "--seed", std::to_string(kSeed)});
    const auto output = RunProgram(BECKON_BIN_DIR "/beckon", args);
    EXPECT_EQ(output.code, 0) << output.text;
    std::vector<nlohmann::json> sessions;
    for (const auto& line : output.lines()) {
      if (line.starts_with("{")) sessions.push_back(nlohmann::json::parse(line));
    }
    return sessions;
  }
};

TEST_F(SystemTest, DemoIsRightTwiceAndTheSecondSessionIsNoLonger) {
  const auto sessions = Demo({"--sessions", "2"});
  ASSERT_EQ(sessions.size(), 2u);
  for (const auto& session : sessions) {
    EXPECT_EQ(session["correct"], true) << session;
    EXPECT_EQ(session["task"]["action"], "Open");
    EXPECT_EQ(session["task"]["category"], "Carton");
    EXPECT_GE(session["questions"], 1);
    EXPECT_GE(session["task"]["posterior"], 0.99);
  }
  EXPECT_LE(sessions[1]["questions"], sessions[0]["questions"]);
}

TEST_F(SystemTest, ASecondRunRemembersTheFirst) {
  auto folder = tool::RunFolder::Make("", "beckon-memory");
  const std::string db = folder->path() + "/history.db";
  const auto first = Demo({"--db", db});
  const auto second = Demo({"--db", db});
  ASSERT_EQ(first.size(), 1u);
  ASSERT_EQ(second.size(), 1u);
  EXPECT_LT(second[0]["questions"], first[0]["questions"]);
  EXPECT_EQ(second[0]["category_questions"], 0) << "what the user said of an object is remembered";
}

TEST_F(SystemTest, DemoSaysInOneLineWhatIsWrongWithItsInput) {
  const std::string beckon = BECKON_BIN_DIR "/beckon";
  const std::vector<std::vector<std::string>> cases = {
      {"--input", "/nowhere/scene.pcd"},
      {"--input", BECKON_SOURCE_DIR "/LICENSE", "--want", "Grasp:Box"},
      {"--want", "Fly:Carton"},
      {"--want", "Carton"},
      {"--db", BECKON_SOURCE_DIR "/LICENSE"},
      {"--policy", "guess"},
      {"--record", BECKON_SOURCE_DIR "/LICENSE"}};
  for (auto args : cases) {
    const std::string what = args[0] + " " + args[1];
    args.insert(args.begin(), {"demo", "--headless"});
    const auto output = RunProgram(beckon, args);
    EXPECT_EQ(output.code, 2) << what << ": " << output.text;
    EXPECT_EQ(output.lines().size(), 1u) << what << ": " << output.text;
  }
}

/// A plane that fills the camera's view, as a small organised cloud: n·p + d = 0 in C.
void WritePlane(const std::string& path, const Eigen::Vector3f& normal, float offset_m) {
  constexpr int kWidth = 160, kHeight = 120;
  constexpr float kFocal = 131;  // px
  Cloud cloud{.width = kWidth, .height = kHeight};
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const Eigen::Vector3f ray((u - kWidth / 2.0F) / kFocal, (v - kHeight / 2.0F) / kFocal, 1);
      cloud.points.push_back(ray * (-offset_m / normal.dot(ray)));
    }
  }
  cloud.colours.assign(cloud.points.size(), Rgb{120, 120, 120});
  ASSERT_TRUE(WritePcdFile(path, cloud));
}

TEST_F(SystemTest, DemoRefusesAnInputThatShowsNoTableOrNothingOnIt) {
  auto folder = tool::RunFolder::Make("", "beckon-input");
  const std::string wall = folder->path() + "/wall.pcd", table = folder->path() + "/table.pcd";
  WritePlane(wall, {0, 0, -1}, 1.5F);
  WritePlane(table, Eigen::Vector3f(0, -0.7F, -0.714F).normalized(), 0.8F);
  const std::vector<std::pair<std::string, std::string>> cases = {
      {wall, "wall.pcd: no table was found (the largest plane can be no table: it is tilted 90"},
      {table, "table.pcd: a table was found, but no object on it"},
      {folder->path(), "a table was found (2 images seen), but no object on it"}};
  for (const auto& [input, complaint] : cases) {
    const Stopwatch watch;
    const auto output = RunProgram(BECKON_BIN_DIR "/beckon",
                                   {"demo", "--headless", "--input", input, "--want", "Grasp:Box"});
    EXPECT_EQ(output.code, 2) << output.text;
    EXPECT_EQ(output.lines().size(), 1u) << output.text;
    EXPECT_NE(output.text.find(complaint), std::string::npos) << output.text;
    EXPECT_LT(watch.Milliseconds(), 15'000);
  }
}

/// SIGKILL of one service after another in mid-session.
class KillTest : public SystemTest, public ::testing::WithParamInterface<std::string> {};

TEST_P(KillTest, TheConversationResumesAndNothingIsLostOrDoubled) {
  const char* more = std::getenv("BECKON_SYSTEM_KILLS");
  const int kills = more != nullptr ? std::atoi(more) : 2;
  LiveSystem system;
  system.config().think_s = 0.1;
  system.StartServices();
  system.StartUser();
  std::mt19937 engine(7);
  for (int kill = 0; kill < kills; ++kill) {
    // Into the session at some point: after one to three of its questions, and up to 0.1 s later.
    const int ended = system.watch().observer().ended();
    const int questions =
        system.watch().observer().questions() + 1 + static_cast<int>(engine() % 3);
    ASSERT_TRUE(system.RunUntil([&] {
      return system.watch().observer().questions() >= questions ||
             system.watch().observer().ended() > ended;
    })) << system.Logs();
    system.RunUntil([] { return false; }, static_cast<double>(engine() % 100) * 1e-3);
    const auto pid = system.supervisor().Pid(GetParam());
    ASSERT_TRUE(pid) << GetParam() << " is down";
    const size_t deaths = system.deaths().size();
    system.supervisor().Signal(GetParam(), SIGKILL);
    ASSERT_TRUE(system.RunUntil([&] {
      return system.deaths().size() > deaths && system.supervisor().Pid(GetParam()) &&
             system.watch().observer().ended() > ended;
    })) << "kill "
        << kill + 1 << "\n"
        << system.Logs();
  }
  // One more, undisturbed.
  const int ended = system.watch().observer().ended();
  ASSERT_TRUE(system.RunUntil([&] { return system.watch().observer().ended() > ended; }))
      << system.Logs();
  for (const auto& record : system.sessions()) {
    EXPECT_TRUE(tool::IsCorrect(record, {"Open", "Carton"}, {})) << record.outcome << "\n"
                                                                 << system.Logs();
  }
  for (const auto& death : system.deaths()) EXPECT_EQ(death.name, GetParam()) << death.exit.Text();
  const auto on_disk = system.SessionsOnDisk();
  for (const auto& [id, count] : on_disk) EXPECT_EQ(count, 1) << id;
  for (const auto& record : system.sessions()) {
    if (!record.task) continue;
    EXPECT_EQ(on_disk.count(record.session_id), 1u) << "published and not on disk";
  }
}

INSTANTIATE_TEST_SUITE_P(Services, KillTest,
                         ::testing::Values("capture", "perception", "pose", "intention",
                                           "ui_bridge"),
                         [](const auto& service) { return service.param; });

/// Bytes that no service may take for a message: random ones, and real messages damaged.
std::vector<uint8_t> Garbage(const std::vector<uint8_t>& real, std::mt19937_64& engine) {
  std::vector<uint8_t> bytes = real;
  const auto random_bytes = [&](size_t n) {
    bytes.resize(n);
    for (auto& byte : bytes) byte = static_cast<uint8_t>(engine());
  };
  switch (engine() % 5) {
    case 0:
      random_bytes(engine() % 300);
      break;
    case 1:
      random_bytes(engine() % 40'000);
      break;
    case 2:
      bytes.resize(bytes.empty() ? 0 : engine() % bytes.size());
      break;  // cut off
    case 3:
      bytes.insert(bytes.end(), 1 + engine() % 100, 0);
      break;  // trailing bytes
    default:  // another type's fingerprint
      for (size_t i = 0; i < std::min<size_t>(8, bytes.size()); ++i)
        bytes[i] ^= static_cast<uint8_t>(1 + engine() % 255);
  }
  return bytes;
}

using Collected = std::map<std::string, std::vector<uint8_t>>;

void Collect(const lcm::ReceiveBuffer* buffer, const std::string& channel, Collected* real) {
  const auto* data = static_cast<const uint8_t*>(buffer->data);
  (*real)[channel].assign(data, data + std::min<uint32_t>(buffer->data_size, 50'000));
}

TEST_F(SystemTest, GarbageOnEveryChannelIsRefusedAndTheConversationGoesOn) {
  LiveSystem system;
  system.config().think_s = 0.05;
  system.StartServices();
  system.StartUser();
  // Real messages to damage, from this very conversation.
  lcm::LCM raw(LcmUrl());
  Collected real;
  raw.subscribeFunction("BECKON_.*", &Collect, &real);
  ASSERT_TRUE(system.RunUntil([&] {
    while (raw.handleTimeout(0) > 0) {
    }
    return system.watch().observer().ended() >= 1 && real.size() >= 9;
  })) << system.Logs();

  std::mt19937_64 engine(11);
  const int ended = system.watch().observer().ended();
  const int tasks = system.watch().robot().tasks_done();
  int sent = 0;
  ASSERT_TRUE(system.RunUntil(
      [&] {
        for (const char* name : {"FRAME", "SCENE", "POSES", "INTERFACE", "QUERY", "ANSWER",
                                 "SESSION", "TASK", "TASK_STATUS", "LABEL", "HISTORY", "STATUS"}) {
          const std::string channel = std::string("BECKON_") + name;
          const auto bytes = Garbage(real[channel], engine);
          raw.publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
          ++sent;
        }
        return sent >= 11'000 && system.watch().observer().ended() >= ended + 2;
      },
      60))
      << sent << " sent\n"
      << system.Logs();
  // Statuses of after the flood.
  system.RunUntil([] { return false; }, 1.5);
  EXPECT_TRUE(system.deaths().empty())
      << system.deaths()[0].name << " died: " << system.deaths()[0].exit.Text();
  for (const char* service : {"perception", "pose", "intention", "ui_bridge"}) {
    const auto* status = system.watch().StatusOf(service);
    ASSERT_NE(status, nullptr) << service;
    const auto refused = std::ranges::find(status->counters, "refused", &msg::Counter::name);
    ASSERT_NE(refused, status->counters.end()) << service;
    EXPECT_GT(refused->value, 50) << service;
  }
  for (const auto& record : system.sessions())
    EXPECT_TRUE(tool::IsCorrect(record, {"Open", "Carton"}, {}));
  const auto confirmed =
      std::ranges::count_if(system.sessions(), [](const auto& r) { return r.task.has_value(); });
  EXPECT_EQ(system.watch().robot().tasks_done(), confirmed);
  EXPECT_GT(system.watch().robot().tasks_done(), tasks);
}

TEST_F(SystemTest, StopReachesIntentionAtOnceAndOnlyResumeLeadsOut) {
  LiveSystem system;
  system.config().think_s = 0.3;
  system.StartServices();
  system.StartUser();
  std::vector<msg::SessionKind> events;
  system.bus().Subscribe<msg::Session>([&](const msg::Session& event) {
    if (event.kind >= msg::SessionKind::kIdle) events.push_back(event.kind);
  });
  ASSERT_TRUE(system.RunUntil([&] { return system.watch().observer().questions() >= 2; }))
      << system.Logs();
  msg::Session stop;
  stop.utime = SystemClock().Now();
  stop.user = "tester";
  stop.device = "test";
  stop.kind = msg::SessionKind::kRequestStop;
  const Stopwatch watch;
  ASSERT_TRUE(system.bus().Publish(stop));
  ASSERT_TRUE(
      system.RunUntil([&] { return std::ranges::count(events, msg::SessionKind::kStopped) > 0; }));
  EXPECT_LT(watch.Milliseconds(), 100);
  EXPECT_TRUE(system.watch().robot().stopped());
  const int tasks = system.watch().robot().tasks_done();
  system.RunUntil([] { return false; }, 1);
  EXPECT_EQ(events.back(), msg::SessionKind::kStopped);
  EXPECT_EQ(system.watch().robot().tasks_done(), tasks);
  stop.kind = msg::SessionKind::kRequestResume;
  ASSERT_TRUE(system.bus().Publish(stop));
  EXPECT_TRUE(system.RunUntil([&] { return events.back() != msg::SessionKind::kStopped; }))
      << system.Logs();
}

TEST_F(SystemTest, TheConsoleAnswersThroughAPipeAndEndsWithIt) {
  LiveSystem system;
  system.StartServices();
  const std::string script = system.run_dir() + "/answers";
  std::ofstream(script) << "2\nmaybe\n";  // one choice and a word: too little for a task
  auto spec = tool::UiBridgeSpec(system.config(), {"console"}, "", false);
  spec.stdin_file = script;
  system.Start(spec, tool::Supervisor::Restart::kNever);
  ASSERT_TRUE(system.RunUntil([&] { return !system.deaths().empty(); })) << system.Logs();
  EXPECT_EQ(system.deaths()[0].name, "ui_bridge");
  EXPECT_EQ(system.deaths()[0].exit.code, 0) << system.Logs();
  ASSERT_TRUE(system.RunUntil([&] { return !system.sessions().empty(); }))
      << "cancelled when nobody answers any more";
  EXPECT_EQ(system.sessions()[0].answers.size(), 1u);
  EXPECT_FALSE(system.sessions()[0].task);
  EXPECT_NE(system.Logs().find("Question 1"), std::string::npos);
}

/// The first question of a log of lcm-logger.
std::optional<msg::Query> FirstQuery(const std::string& log) {
  lcm::LogFile file(log, "r");
  if (!file.good()) return {};
  while (const auto* event = file.readNextEvent()) {
    if (event->channel != Codec<msg::Query>::kChannel) continue;
    const auto* data = static_cast<const uint8_t*>(event->data);
    auto query = Codec<msg::Query>::Decode({data, static_cast<size_t>(event->datalen)});
    if (query) return *std::move(query);
  }
  return {};
}

TEST_F(SystemTest, FramesOfALogLeadToTheSameFirstQuestion) {
  auto folder = tool::RunFolder::Make("", "beckon-replay");
  const std::string log = folder->path() + "/demo.lcm";
  ASSERT_EQ(Demo({"--record", log}).size(), 1u);
  const auto recorded = FirstQuery(log);
  ASSERT_TRUE(recorded) << "nothing was asked, or nothing was recorded";

  LiveSystem system;
  std::optional<msg::Query> replayed;
  system.bus().Subscribe<msg::Query>([&](const msg::Query& query) {
    if (!replayed) replayed = query;
  });
  system.StartServices(/*with_capture=*/false);
  tool::ProcessSpec player;
  player.name = "player";
  player.program = "lcm-logplayer";
  player.args = {"--lcm-url=" + LcmUrl(), "--regexp=BECKON_FRAME", log};
  player.log_file = system.run_dir() + "/player.log";
  system.Start(player, tool::Supervisor::Restart::kAlways);  // over and over
  system.StartUser();
  ASSERT_TRUE(system.RunUntil([&] { return replayed.has_value(); })) << system.Logs();
  EXPECT_EQ(replayed->text, recorded->text);
  EXPECT_EQ(replayed->kind, recorded->kind);
  EXPECT_EQ(replayed->any_action, recorded->any_action);
  EXPECT_EQ(replayed->actions, recorded->actions);
  EXPECT_EQ(replayed->any_object, recorded->any_object);
  const auto name = [](const msg::ObjectRef& o) {
    return o.category + " " + std::to_string(o.instance);
  };
  std::vector<std::string> then, now;
  for (const auto& object : recorded->objects) then.push_back(name(object));
  for (const auto& object : replayed->objects) now.push_back(name(object));
  EXPECT_EQ(now, then);
}

}  // namespace
}  // namespace beckon::system_test
