#include "tests/system/live_system.h"

#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "services/base/app.h"
#include "tools/beckon/child_process.h"
#include "tools/beckon/private_bus.h"

namespace beckon::system_test {
namespace {

namespace fs = std::filesystem;

std::string g_lcm_url;       // NOLINT: set once, by main
std::string g_bus_obstacle;  // NOLINT
std::string g_obstacle;      // NOLINT

std::string ReadText(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string FindObstacle(const tool::PrivateBus& bus) {
  if (!bus.isolated) return bus.note;
  if (!fs::exists(SharedFile("categories.model")))
    return SharedFile("categories.model") + " is not there";
  for (const char* program : {"capture", "perception", "pose", "intention", "ui-bridge"}) {
    const std::string path = std::string(BECKON_BIN_DIR) + "/beckon-" + program;
    if (!fs::exists(path)) return path + " is not built";
  }
  return {};
}

}  // namespace

const std::string& LcmUrl() { return g_lcm_url; }
const std::string& BusObstacle() { return g_bus_obstacle; }
const std::string& Obstacle() { return g_obstacle; }

LiveSystem::LiveSystem(const std::string& db)
    : folder_(tool::RunFolder::Make("", "beckon-system-test")),
      supervisor_(loop_, steady_, [this](const tool::Death& death) { deaths_.push_back(death); }),
      bus_(std::move(*Bus::Open(LcmUrl()))) {
  config_.bin_dir = BECKON_BIN_DIR;
  config_.run_dir = folder_->path();
  config_.lcm_url = LcmUrl();
  config_.seed = kSeed;
  config_.db = db.empty() ? folder_->path() + "/history.db" : db;
  config_.user = "tester";
  loop_.AddFd(bus_->fd(), [this] { bus_->HandleReadable(); });
  watch_ = std::make_unique<tool::BusWatch>(
      *bus_, clock_, steady_, config_.user,
      [this](const tool::SessionRecord& record) { sessions_.push_back(record); });
}

LiveSystem::~LiveSystem() { supervisor_.Stop(); }

void LiveSystem::Start(const tool::ProcessSpec& spec, tool::Supervisor::Restart restart) {
  const auto started = supervisor_.Start(spec, restart);
  ASSERT_TRUE(started) << started.error().message;
}

void LiveSystem::StartServices(bool with_capture) {
  using enum tool::Supervisor::Restart;
  Start(tool::PerceptionSpec(config_), kAlways);
  Start(tool::PoseSpec(config_), kAlways);
  Start(tool::IntentionSpec(config_), kAlways);
  if (with_capture) Start(tool::CaptureSpec(config_), kAlways);
}

void LiveSystem::StartUser(const std::string& want) {
  if (config_.input.empty()) {
    const auto truth = tool::TruthSpec(config_);
    ASSERT_EQ(RunProgram(truth.program, truth.args).code, 0);
  }
  config_.sessions = 1'000'000;
  Start(tool::UiBridgeSpec(config_, {"simulated"}, want, false),
        tool::Supervisor::Restart::kAlways);
}

bool LiveSystem::RunUntil(const std::function<bool()>& condition, double timeout_s) {
  if (condition()) return true;
  bool met = false;
  const auto look = loop_.Every(2'000, [&] {
    met = condition();
    if (met) loop_.Stop();
  });
  const auto deadline =
      loop_.After(static_cast<Utime>(timeout_s * kSecond), [this] { loop_.Stop(); });
  loop_.Run();
  loop_.Cancel(look);
  loop_.Cancel(deadline);
  return met;
}

std::string LiveSystem::Logs() const {
  std::string text;
  for (const auto& entry : fs::directory_iterator(folder_->path())) {
    if (entry.path().extension() != ".log") continue;
    const std::string log = ReadText(entry.path());
    text += "== " + entry.path().filename().string() + "\n" +
            log.substr(log.size() > 1500 ? log.size() - 1500 : 0);
  }
  return text;
}

std::map<std::string, int> LiveSystem::SessionsOnDisk() {
  supervisor_.Stop("intention", SIGTERM, 5000);
  const auto history =
      RunProgram(config_.bin_dir + "/beckon-intention", {"history", "--json", "--db", config_.db});
  EXPECT_EQ(history.code, 0) << history.text;
  std::map<std::string, int> sessions;
  for (const auto& line : history.lines()) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (json.is_object() && json.contains("session_id"))
      ++sessions[json["session_id"].get<std::string>()];
  }
  return sessions;
}

std::vector<std::string> Output::lines() const {
  std::vector<std::string> all;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) all.push_back(line);
  return all;
}

Output RunProgram(const std::string& program, const std::vector<std::string>& args, int timeout_s) {
  auto folder = tool::RunFolder::Make("", "beckon-run-program");
  tool::ProcessSpec spec;
  spec.name = program;
  spec.program = program;
  spec.args = args;
  spec.log_file = folder->path() + "/output";
  auto process = tool::ChildProcess::Start(spec);
  if (!process) return {-1, process.error().message};
  const auto exit = process->Wait(timeout_s * 1000);
  return {exit && exit->signal == 0 ? exit->code : -1, ReadText(spec.log_file)};
}

}  // namespace beckon::system_test

/// Enters the private network before anything else: it takes a process of one thread.
int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  spdlog::set_level(spdlog::level::err);  // refusing garbage is what is tested
  if (!::testing::GTEST_FLAG(list_tests)) {
    const auto bus = beckon::tool::EnterPrivateBus();
    beckon::system_test::g_lcm_url = bus.lcm_url;
    beckon::system_test::g_bus_obstacle = bus.isolated ? "" : bus.note;
    beckon::system_test::g_obstacle = beckon::system_test::FindObstacle(bus);
  }
  return RUN_ALL_TESTS();
}
