// Whole conversations over the memory bus between intention and the simulated front end, by every
// way of answering: yes and no, a choice, a scan, vectors.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>

#include "services/intention/service.h"
#include "services/ui_bridge/service.h"
#include "tests/intention/temporary_folder.h"

namespace beckon::system_test {
namespace {

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

/// Sees what every front end is shown. One of them may press stop at a question, and go on.
class Watcher final : public ui_bridge::FrontEnd {
 public:
  struct Seen {
    std::vector<int64_t> queries;
    std::vector<msg::SessionKind> events;
    std::vector<std::string> tasks;
  };
  static inline std::map<std::string, Seen> seen;  // by device
  static inline std::string stopper;               // device that presses stop at the first question

  explicit Watcher(const ui_bridge::FrontEndSetup& setup) : setup_(setup) {}
  msg::Interface Announce() const override { return {}; }
  void Begin() override {}
  void Present(const msg::Query& query) override {
    seen[setup_.device].queries.push_back(query.id);
    if (stopper != setup_.device) return;
    stopper.clear();
    resumes_ = true;
    setup_.sink.Request(msg::SessionKind::kRequestStop);
  }
  void Withdraw() override {}
  void ShowSession(const msg::Session& event) override {
    seen[setup_.device].events.push_back(event.kind);
    if (event.kind == msg::SessionKind::kStopped && resumes_)
      setup_.sink.Request(msg::SessionKind::kRequestResume);
  }
  void ShowNotice(const std::string&) override {}
  void ShowTask(const msg::Task& task) override {
    seen[setup_.device].tasks.push_back(task.action);
  }
  bool Endless() const override { return true; }
  std::string State() const override { return "watches"; }

 private:
  const ui_bridge::FrontEndSetup setup_;
  bool resumes_ = false;
};

class WatcherFactory final : public ui_bridge::FrontEndFactory {
 public:
  std::string name() const override { return "watcher"; }
  std::string summary() const override { return "watches"; }
  Result<std::unique_ptr<ui_bridge::FrontEnd>> Create(
      const ui_bridge::FrontEndSetup& setup) override {
    return std::unique_ptr<ui_bridge::FrontEnd>(std::make_unique<Watcher>(setup));
  }
};

/// Perception and a robot around the two services.
class ChoicesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    loop_.AddFd(bus_->fd(), [this] { bus_->HandleReadable(); });
    loop_.Every(kSecond / 5, [this] { ShowScene(); });
    loop_.After(30 * kSecond, [this] {
      ADD_FAILURE() << "not done after 30 s";
      loop_.Stop();
    });
    bus_->Subscribe<msg::Query>([this](const msg::Query& query) {
      if (queries_.empty() || queries_.back().id != query.id) queries_.push_back(query);
    });
    bus_->Subscribe<msg::Answer>([this](const msg::Answer& answer) {
      if (answers_.empty() || answers_.back().query_id != answer.query_id)
        answers_.push_back(answer);
    });
    bus_->Subscribe<msg::Interface>([this](const msg::Interface& i) {
      if (i.device == ui_bridge::DefaultDevice("simulated")) interface_ = i;
    });
    bus_->Subscribe<msg::Task>([this](const msg::Task& task) {
      if (tasks_.empty() || tasks_.back().task_id != task.task_id) tasks_.push_back(task);
      msg::TaskStatus status;
      status.utime = clock_.Now();
      status.task_id = task.task_id;
      status.state = msg::TaskState::kDone;
      ASSERT_TRUE(bus_->Publish(status));
    });
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
                     Object(3, "Mug", -0.2, 0.6), Object(4, "Box", 0.3, 0.7),
                     Object(5, "Tin", -0.3, 0.5)};
    ASSERT_TRUE(bus_->Publish(scene));
    msg::Poses poses;
    poses.utime = scene.utime;
    poses.seq = poses.scene_seq = scene.seq;
    ASSERT_TRUE(bus_->Publish(poses));
  }

  /// The simulated user lives `sessions` conversations.
  void Converse(const std::string& want, int sessions, std::vector<std::string> more) {
    intention::ServiceConfig config;
    config.db = (folder_ / "beckon.db").string();
    config.affordances = BECKON_SOURCE_DIR "/services/intention/affordances.toml";
    config.phrases = BECKON_SOURCE_DIR "/services/intention/questions.en.toml";
    config.machine = "test";
    auto intention = intention::Service::Start(config, *bus_, loop_, clock_);
    ASSERT_TRUE(intention.ok()) << intention.error().message;
    auto factories = ui_bridge::MakeFrontEndFactories();
    const auto simulated =
        std::ranges::find(factories, "simulated", [](const auto& f) { return f->name(); });
    CLI::App app;
    (*simulated)->AddOptions(app);
    more.insert(more.end(), {"--want", want});
    std::ranges::reverse(more);
    app.parse(more);
    ui_bridge::Service bridge({.user = "ann", .device = "", .exit_after_sessions = sessions}, *bus_,
                              loop_, clock_, steady_);
    ASSERT_TRUE(bridge.Add(**simulated));
    WatcherFactory watcher;
    ASSERT_TRUE(bridge.Add(watcher));
    // As on another machine.
    ui_bridge::Service elsewhere({.user = "ann", .device = "elsewhere", .exit_after_sessions = 0},
                                 *bus_, loop_, clock_, steady_);
    ASSERT_TRUE(elsewhere.Add(watcher));
    Watcher::seen.clear();
    bridge.Begin();
    elsewhere.Begin();
    loop_.Run();
    ASSERT_EQ(tasks_.size(), static_cast<size_t>(sessions - stopped_sessions_));
    for (const msg::Task& task : tasks_) {
      EXPECT_EQ(task.action + ":" + task.object.category, want);
      EXPECT_EQ(task.object.instance, 1);
      EXPECT_GE(task.posterior, 0.99);
    }
  }

  int Choices() const {
    return static_cast<int>(
        std::ranges::count(queries_, msg::QueryKind::kChoice, &msg::Query::kind));
  }
  size_t MostOptions() const {
    size_t most = 0;
    for (const auto& query : queries_) most = std::max(most, query.options.size());
    return most;
  }

  SystemClock clock_;
  SteadyClock steady_;
  RunLoop loop_;
  std::unique_ptr<Bus> bus_ = std::move(*Bus::Open("memq://"));
  intention::TemporaryFolder folder_;
  int64_t scenes_ = 0;
  int stopped_sessions_ = 0;  // that somebody stops
  msg::Interface interface_;
  std::vector<msg::Query> queries_;
  std::vector<msg::Answer> answers_;
  std::vector<msg::Task> tasks_;
};

TEST_F(ChoicesTest, SeveralFrontEndsHaveOneTruth) {
  Converse("Open:Carton", 1, {});
  std::vector<int64_t> asked;
  for (const auto& query : queries_) asked.push_back(query.id);
  ASSERT_EQ(Watcher::seen.size(), 2u);
  for (const auto& [device, seen] : Watcher::seen) {
    EXPECT_EQ(seen.queries, asked) << device;
    EXPECT_EQ(seen.events.back(), msg::SessionKind::kConfirmed) << device;
    EXPECT_EQ(seen.tasks, std::vector<std::string>{"Open"}) << device;
  }
  for (const auto& answer : answers_)
    EXPECT_EQ(answer.device, ui_bridge::DefaultDevice("simulated"));
}

TEST_F(ChoicesTest, AStopPressedAnywhereIsShownEverywhereAndEndsOnlyByAResume) {
  Watcher::stopper = "elsewhere";
  stopped_sessions_ = 1;
  Converse("Open:Carton", 2, {"--think", "0.3"});
  ASSERT_EQ(Watcher::seen.size(), 2u);
  for (const auto& [device, seen] : Watcher::seen) {
    EXPECT_EQ(std::ranges::count(seen.events, msg::SessionKind::kStopped), 1) << device;
    EXPECT_EQ(seen.events.back(), msg::SessionKind::kConfirmed) << device;
  }
}

TEST_F(ChoicesTest, ASimulatedUserWhoStopsGoesOnAfterwards) {
  stopped_sessions_ = 1;
  // Of this seed's chances one comes true.
  Converse("Open:Carton", 2, {"--stop", "0.4", "--seed", "4"});
  EXPECT_EQ(std::ranges::count(Watcher::seen["elsewhere"].events, msg::SessionKind::kStopped), 1);
}

TEST_F(ChoicesTest, AYesNoUserIsNeverOfferedAChoice) {
  Converse("Drink:Mug", 1, {});
  EXPECT_EQ(interface_.kind, msg::InterfaceKind::kYesNo);
  EXPECT_EQ(Choices(), 0);
}

TEST_F(ChoicesTest, AChoiceLeadsToTheTask) {
  Converse("Open:Carton", 2,
           {"--announce", "choice", "--max-options", "6", "--seconds-per-question", "3",
            "--seconds-per-option", "0.3"});
  EXPECT_EQ(interface_.kind, msg::InterfaceKind::kChoice);
  EXPECT_EQ(interface_.max_options, 6);
  EXPECT_FLOAT_EQ(interface_.seconds_per_question, 3);
  EXPECT_FLOAT_EQ(interface_.seconds_per_option, 0.3f);
  EXPECT_GE(Choices(), 1);
  EXPECT_LE(MostOptions(), 6u);
  for (const auto& query : queries_) {
    if (query.kind != msg::QueryKind::kChoice) continue;
    EXPECT_EQ(query.prospects.size(), query.options.size());
    EXPECT_GT(query.expected_seconds, 3);
    EXPECT_TRUE(query.options.back().actions.empty() && query.options.back().objects.empty());
    for (const auto& option : query.options) {
      for (const int id : option.objects)
        EXPECT_EQ(std::ranges::count(query.objects, id, &msg::ObjectRef::object_id), 1);
    }
  }
}

TEST_F(ChoicesTest, AScanLeadsToTheTask) {
  Converse("Pour:Tin", 1,
           {"--announce", "scan", "--max-options", "8", "--seconds-per-question", "1",
            "--seconds-per-option", "1.5"});
  EXPECT_EQ(interface_.kind, msg::InterfaceKind::kScan);
  EXPECT_GE(Choices(), 1);
}

TEST_F(ChoicesTest, SoftVectorsLeadToTheTask) {
  Converse("Grasp:Mug", 1,
           {"--announce", "vector", "--max-options", "8", "--seconds-per-question", "10"});
  EXPECT_EQ(interface_.kind, msg::InterfaceKind::kVector);
  EXPECT_GE(Choices(), 1);
  for (const auto& answer : answers_) {
    EXPECT_EQ(std::ranges::count(answer.likelihoods, 0.0), 0);
    EXPECT_NEAR(*std::ranges::max_element(answer.likelihoods), 0.9, 1e-9);
  }
}

TEST_F(ChoicesTest, WrongChoicesAreOutvoted) {
  Converse("Open:Box", 3, {"--announce", "choice", "--flip", "0.1", "--seed", "4"});
  EXPECT_FLOAT_EQ(interface_.false_yes, 0.1f);
  EXPECT_GE(Choices(), 1);
}

}  // namespace
}  // namespace beckon::system_test
