// Two real intention services share one user: one conversation and one task, whichever is killed or
// stands still. This program is the table, two front ends and the robot.
#include <gtest/gtest.h>
#include <signal.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <random>

#include "services/base/app.h"
#include "services/base/bus.h"
#include "services/base/run_loop.h"
#include "services/ui_bridge/dialogue.h"
#include "tools/beckon/child_process.h"
#include "tools/beckon/private_bus.h"
#include "tools/beckon/run_folder.h"

namespace beckon::system_test {
namespace {

std::string g_lcm_url;   // NOLINT: set once, by main
std::string g_obstacle;  // NOLINT

constexpr char kUser[] = "ann";

msg::SceneObject Object(int id, const std::string& category, double x, double y) {
  msg::SceneObject object;
  object.id = id;
  object.category = category;
  object.confidence = 0.9f;
  object.probabilities = {{category, 1.0f}};
  object.centroid_W = {x, y, 0.05};
  object.extent_W = {0.06, 0.06, 0.1};
  object.n_points = 100;
  return object;
}

/// Wants to drink from the second mug, and says so after a moment's thought.
class Person final : public ui_bridge::DialogueOutput {
 public:
  Person(const std::string& device, Bus& bus, RunLoop& loop, const Clock& clock,
         const Clock& steady)
      : bus_(bus),
        loop_(loop),
        dialogue_(
            {.user = kUser, .device = device, .listen_us = kSecond / 2}, clock, steady,
            [device, n = 0]() mutable { return device + "-" + std::to_string(++n); }, *this) {
    bus_.Subscribe<msg::Query>([this](const msg::Query& query) { dialogue_.OnQuery(query); });
    bus_.Subscribe<msg::Session>([this](const msg::Session& event) { dialogue_.OnSession(event); });
    tick_ = loop_.Every(kSecond / 20, [this] { dialogue_.Tick(); });
  }
  ~Person() override { loop_.Cancel(tick_); }

  void Send(const msg::Answer& answer) override { EXPECT_TRUE(bus_.Publish(answer)); }
  void Send(const msg::Session& request) override { EXPECT_TRUE(bus_.Publish(request)); }
  void Present(const msg::Query& query) override {
    presented.push_back(query);
    if (!answers) return;
    const bool action = query.any_action || std::ranges::count(query.actions, "Drink") > 0;
    const bool object = query.any_object || std::ranges::any_of(query.objects, [](const auto& o) {
                          return o.object_id == 3;
                        });
    std::vector<double> likelihoods{1, 0};
    if (!action || !object) std::swap(likelihoods[0], likelihoods[1]);
    loop_.After(kSecond / 10,
                [this, id = query.id, likelihoods] { dialogue_.Answer(id, likelihoods); });
  }
  void Withdraw() override {}
  void ShowSession(const msg::Session& event) override {
    confirmed += event.kind == msg::SessionKind::kConfirmed ? 1 : 0;
  }
  void ShowUser(const std::string&) override {}
  void ShowNotice(const std::string&) override {}

  void Start() { dialogue_.Start(); }

  std::vector<msg::Query> presented;
  int confirmed = 0;
  bool answers = true;

 private:
  Bus& bus_;
  RunLoop& loop_;
  ui_bridge::Dialogue dialogue_;
  RunLoop::TimerId tick_ = 0;
};

class MachinesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!g_obstacle.empty()) GTEST_SKIP() << g_obstacle;
    loop_.AddFd(bus_->fd(), [this] { bus_->HandleReadable(); });
    loop_.Every(kSecond / 5, [this] { ShowScene(); });
    bus_->Subscribe<msg::Query>([this](const msg::Query& query) {
      if (queries_.empty() || queries_.back().id != query.id) queries_.push_back(query);
      asked_[query.seal.sender] = steady_.Now();
    });
    bus_->Subscribe<msg::Task>([this](const msg::Task& task) {
      told_[task.seal.sender] = steady_.Now();
      tasks_.try_emplace(task.task_id, task);
      if (acknowledges_)
        EXPECT_TRUE(bus_->Publish(
            msg::TaskStatus{clock_.Now(), task.task_id, msg::TaskState::kAccepted, "", {}}));
    });
    bus_->Subscribe<msg::Status>([this](const msg::Status& status) {
      if (status.service == "intention") statuses_[status.pid] = status;
    });
    for (const char* name : {"kitchen", "bedroom"}) StartMachine(name);
    kitchen_.answers = true;
    bedroom_.answers = false;  // its user sits in the kitchen
    ASSERT_TRUE(RunUntil([this] { return statuses_.size() == 2; })) << "they do not start";
  }

  void StartMachine(const std::string& name) {
    tool::ProcessSpec spec;
    spec.name = name;
    spec.program = BECKON_BIN_DIR "/beckon-intention";
    spec.args = {"--db",   folder_->path() + "/" + name + ".db", "--machine", name, "--lcm-url",
                 g_lcm_url};
    spec.log_file = folder_->path() + "/" + name + ".log";
    auto started = tool::ChildProcess::Start(spec);
    ASSERT_TRUE(started) << started.error().message;
    machines_.erase(name);
    machines_.emplace(name, *std::move(started));
  }

  void ShowScene() {
    msg::Scene scene;
    scene.utime = clock_.Now();
    scene.seq = scene.frame_seq = ++scenes_;
    scene.source = "test";
    scene.width = 640;
    scene.height = 480;
    scene.has_table = true;
    scene.objects = {Object(1, "Carton", 0, 0.5), Object(2, "Mug", 0.2, 0.4),
                     Object(3, "Mug", -0.2, 0.6)};
    EXPECT_TRUE(bus_->Publish(scene));
    msg::Poses poses;
    poses.utime = scene.utime;
    poses.seq = poses.scene_seq = scene.seq;
    EXPECT_TRUE(bus_->Publish(poses));
  }

  bool RunUntil(const std::function<bool()>& condition, double timeout_s = 20) {
    bool met = condition();
    if (met) return true;
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

  /// The name of the machine that asked last.
  std::string Leader() const {
    const std::string& sender = queries_.back().seal.sender;
    return sender.substr(0, sender.find('/'));
  }
  int64_t Counter(const std::string& machine, const std::string& name) const {
    const auto status = statuses_.find(machines_.at(machine).pid());
    if (status == statuses_.end()) return -1;
    const auto found = std::ranges::find(status->second.counters, name, &msg::Counter::name);
    return found == status->second.counters.end() ? -1 : found->value;
  }
  void BeginDialogue(size_t questions) {
    const size_t asked = queries_.size();
    kitchen_.Start();
    ASSERT_TRUE(RunUntil([&] { return queries_.size() >= asked + questions; })) << "nothing asked";
  }
  void ExpectTasks(size_t n) const {
    EXPECT_EQ(tasks_.size(), n);
    for (const auto& [id, task] : tasks_) {
      EXPECT_EQ(task.action, "Drink");
      EXPECT_EQ(task.object.object_id, 3);
    }
  }

  Result<tool::RunFolder> folder_ = tool::RunFolder::Make("", "beckon-machines-test");
  RunLoop loop_;
  SystemClock clock_;
  SteadyClock steady_;
  std::unique_ptr<Bus> bus_ = std::move(*Bus::Open(g_lcm_url));
  std::map<std::string, tool::ChildProcess> machines_;
  std::map<int, msg::Status> statuses_;  // by pid
  std::vector<msg::Query> queries_;      // each once, unless two services ask in turns
  std::map<std::string, Utime> asked_;   // by sender: last
  std::map<std::string, Utime> told_;    // likewise, of tasks
  std::map<std::string, msg::Task> tasks_;
  bool acknowledges_ = true;
  int64_t scenes_ = 0;
  Person kitchen_{"switch@kitchen", *bus_, loop_, clock_, steady_};
  Person bedroom_{"switch@bedroom", *bus_, loop_, clock_, steady_};
};

TEST_F(MachinesTest, HoldOneConversationWithTheUserOfTwoFrontEnds) {
  BeginDialogue(1);
  bedroom_.Start();
  ASSERT_TRUE(RunUntil([&] { return kitchen_.confirmed == 1 && bedroom_.confirmed == 1; }));
  ExpectTasks(1);
  EXPECT_EQ(asked_.size(), 1u) << "two services asked";
  EXPECT_EQ(kitchen_.presented.size(), queries_.size());
  EXPECT_EQ(told_.size(), 1u);
}

TEST_F(MachinesTest, OneFinishesWhatAKilledOneBegan) {
  const char* more = std::getenv("BECKON_SYSTEM_KILLS");
  const int kills = more != nullptr ? std::atoi(more) : 2;
  std::mt19937 random(7);
  for (int kill = 1; kill <= kills; ++kill) {
    BeginDialogue(1 + random() % 2);
    RunUntil([] { return false; }, static_cast<double>(random() % 100) * 1e-3);
    const std::string session = queries_.back().session_id;
    const std::string killed = Leader(), other = killed == "kitchen" ? "bedroom" : "kitchen";
    machines_.at(killed).Signal(SIGKILL);
    const Stopwatch watch;
    ASSERT_TRUE(RunUntil([&] { return Leader() == other || tasks_.contains(session); }))
        << "kill " << kill;
    EXPECT_LT(watch.Milliseconds(), 3000) << "lease, claim, and a busy machine";
    ASSERT_TRUE(RunUntil([&] { return kitchen_.confirmed == kill; })) << "kill " << kill;
    EXPECT_TRUE(tasks_.contains(session));
    ExpectTasks(static_cast<size_t>(kill));
    StartMachine(killed);
    ASSERT_TRUE(RunUntil([&] { return Counter(killed, "lease_term") >= 0; }));
  }
}

TEST_F(MachinesTest, OneThatWasStoppedInMidDialogueLeavesItToTheOther) {
  BeginDialogue(2);
  const std::string stopped = Leader(), other = stopped == "kitchen" ? "bedroom" : "kitchen";
  machines_.at(stopped).Signal(SIGSTOP);
  ASSERT_TRUE(RunUntil([&] { return Leader() == other; }));
  const Utime taken_over = steady_.Now();
  machines_.at(stopped).Signal(SIGCONT);  // in the middle of the other's questions
  ASSERT_TRUE(RunUntil([&] { return kitchen_.confirmed == 1; }));
  ASSERT_TRUE(RunUntil([&] { return Counter(stopped, "yielded") == 1; }));
  ExpectTasks(1);
  EXPECT_EQ(Counter(other, "taken_over"), 1);
  EXPECT_LT(asked_[stopped + "/intention"], taken_over) << "it asked again";
  EXPECT_EQ(told_.count(stopped + "/intention"), 0u);
}

std::string FindObstacle(const tool::PrivateBus& bus) {
  if (!bus.isolated) return bus.note;
  if (!std::filesystem::exists(BECKON_BIN_DIR "/beckon-intention"))
    return BECKON_BIN_DIR "/beckon-intention is not built";
  return {};
}

}  // namespace
}  // namespace beckon::system_test

/// Enters the private network before anything else: it takes a process of one thread.
int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  spdlog::set_level(spdlog::level::err);
  if (!::testing::GTEST_FLAG(list_tests)) {
    const auto bus = beckon::tool::EnterPrivateBus();
    beckon::system_test::g_lcm_url = bus.lcm_url;
    beckon::system_test::g_obstacle = beckon::system_test::FindObstacle(bus);
  }
  return RUN_ALL_TESTS();
}
