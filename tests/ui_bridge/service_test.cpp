// Front ends on a bus: a front end of this test's own registers itself and leads a whole
// conversation.
#include "services/ui_bridge/service.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "services/ui_bridge/uuid.h"

namespace beckon::ui_bridge {
namespace {

using ::testing::Contains;
using ::testing::IsSupersetOf;

/// Says yes to everything and leaves after one session.
class Agreeable final : public FrontEnd {
 public:
  explicit Agreeable(FrontEndSink& sink) : sink_(sink) {}
  msg::Interface Announce() const override { return {}; }
  void Begin() override { sink_.Request(msg::SessionKind::kRequestStart); }
  void Present(const msg::Query& query) override {
    sink_.Answer(query.id, OneHot(0, query.options.size()));
  }
  void Withdraw() override {}
  void ShowSession(const msg::Session& event) override {
    if (event.kind == msg::SessionKind::kConfirmed) sink_.Finish();
  }
  void ShowNotice(const std::string&) override {}
  void ShowTaskStatus(const msg::TaskStatus& status) override {
    task_states.push_back(status.state);
  }
  void ShowTask(const msg::Task& task) override { tasks.push_back(task.task_id); }
  std::string State() const override { return "agrees"; }

  static inline std::vector<std::string> tasks;           // likewise
  static inline std::vector<msg::TaskState> task_states;  // shown to any of them

 private:
  FrontEndSink& sink_;
};

class AgreeableFactory final : public FrontEndFactory {
 public:
  std::string name() const override { return "agreeable"; }
  std::string summary() const override { return "says yes"; }
  Result<std::unique_ptr<FrontEnd>> Create(const FrontEndSetup& setup) override {
    return std::unique_ptr<FrontEnd>(std::make_unique<Agreeable>(setup.sink));
  }
};

const FrontEndRegistration kRegistration([]() -> std::unique_ptr<FrontEndFactory> {
  return std::make_unique<AgreeableFactory>();
});

std::unique_ptr<FrontEndFactory> Factory(const std::string& name) {
  for (auto& factory : MakeFrontEndFactories()) {
    if (factory->name() == name) return std::move(factory);
  }
  return nullptr;
}

TEST(FrontEnds, RegisterThemselves) {
  std::vector<std::string> names;
  for (const auto& factory : MakeFrontEndFactories()) names.push_back(factory->name());
  EXPECT_THAT(names, IsSupersetOf({"agreeable", "console", "simulated"}));
}

TEST(Uuid, IsOfVersionFourAndNeverTheSame) {
  std::set<std::string> seen;
  for (int i = 0; i < 1000; ++i) {
    const std::string id = NewUuid();
    EXPECT_THAT(id, ::testing::MatchesRegex(
                        "[0-9a-f]{8}-[0-9a-f]{4}-4[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}"));
    seen.insert(id);
  }
  EXPECT_EQ(seen.size(), 1000u);
}

TEST(Users, AreNamedByPlainCharacters) {
  EXPECT_TRUE(ValidateUser("ann.b-2_c"));
  for (const char* name : {"", "an n", "../x", "ann/é"}) EXPECT_FALSE(ValidateUser(name)) << name;
  EXPECT_FALSE(ValidateUser(std::string(65, 'a')));
  EXPECT_TRUE(ValidateUser(DefaultUser()));
}

/// Bus and loop with a deadline, and an intention that asks two questions.
class ServiceTest : public ::testing::Test {
 protected:
  void SetUp() override {
    loop_.AddFd(bus_->fd(), [this] { bus_->HandleReadable(); });
    loop_.After(10 * kSecond, [this] {
      ADD_FAILURE() << "not done after 10 s";
      loop_.Stop();
    });
    bus_->Subscribe<msg::Interface>([this](const msg::Interface& i) { devices_.insert(i.device); });
    bus_->Subscribe<msg::Session>([this](const msg::Session& request) {
      if (request.kind != msg::SessionKind::kRequestStart || !session_.empty()) return;
      session_ = request.session_id;
      Announce(msg::SessionKind::kBegun);
      Ask(1);
    });
    bus_->Subscribe<msg::Answer>([this](const msg::Answer& answer) {
      answers_.push_back(answer);
      if (answer.query_id == 1) Ask(2);
      if (answer.query_id != 2) return;
      if (quick_robot_) {
        ASSERT_TRUE(bus_->Publish(RobotIsDone()));
      }
      Announce(msg::SessionKind::kConfirmed);
    });
  }

  void Announce(msg::SessionKind kind) {
    msg::Session event;
    event.utime = clock_.Now();
    event.session_id = session_;
    event.user = "ann";
    event.kind = kind;
    ASSERT_TRUE(bus_->Publish(event));
  }

  msg::TaskStatus RobotIsDone() const {
    msg::TaskStatus status;
    status.utime = clock_.Now();
    status.task_id = session_;
    status.state = msg::TaskState::kDone;
    return status;
  }

  void Ask(int64_t id) {
    msg::Query query;
    query.utime = clock_.Now();
    query.id = id;
    query.session_id = session_;
    query.user = "ann";
    query.text = "This?";
    query.options = {{.text = "Yes"}, {.text = "No"}};
    query.scene_seq = 1;
    ASSERT_TRUE(bus_->Publish(query));
  }

  SystemClock clock_;
  SteadyClock steady_;
  RunLoop loop_;
  std::unique_ptr<Bus> bus_ = std::move(*Bus::Open("memq://"));
  std::string session_;
  std::set<std::string> devices_;
  std::vector<msg::Answer> answers_;
  bool quick_robot_ = false;  // done before intention has said that it was told
};

TEST_F(ServiceTest, LeadsAConversationAndEndsWhenItsFrontEndIsThrough) {
  Service service({.user = "ann", .device = "", .exit_after_sessions = 0}, *bus_, loop_, clock_,
                  steady_);
  ASSERT_TRUE(service.Add(*Factory("agreeable")));
  EXPECT_EQ(service.State(), "agrees");
  service.Begin();
  loop_.Run();
  ASSERT_GE(answers_.size(), 2u);
  EXPECT_EQ(answers_[0].likelihoods, (std::vector<double>{1, 0}));
  EXPECT_EQ(answers_[0].session_id, session_);
  EXPECT_EQ(answers_[0].device, DefaultDevice("agreeable"));
  EXPECT_GT(answers_[1].seal.counter, answers_[0].seal.counter);
  EXPECT_THAT(devices_, Contains(DefaultDevice("agreeable")));
}

TEST_F(ServiceTest, ShowsWhatARobotSaysBeforeTheConfirmationToo) {
  quick_robot_ = true;
  Agreeable::task_states.clear();
  Service service({.user = "ann", .device = "", .exit_after_sessions = 0}, *bus_, loop_, clock_,
                  steady_);
  ASSERT_TRUE(service.Add(*Factory("agreeable")));
  service.Begin();
  loop_.Run();
  EXPECT_EQ(Agreeable::task_states, std::vector{msg::TaskState::kDone});
}

TEST_F(ServiceTest, ShowsEachTaskOnceHoweverManyAreRepeated) {
  Agreeable::tasks.clear();
  Service service({.user = "ann", .device = "", .exit_after_sessions = 0}, *bus_, loop_, clock_,
                  steady_);
  ASSERT_TRUE(service.Add(*Factory("agreeable")));
  service.Begin();
  for (const char* id : {"first", "second", "first", "second", "first"}) {
    msg::Task task;
    task.utime = clock_.Now();
    task.task_id = id;
    task.user = "ann";
    task.action = "Open";
    task.object = {.object_id = 1, .category = "Carton", .instance = 1};
    task.posterior = 1;
    task.expires_utime = clock_.Now() + kSecond;
    ASSERT_TRUE(bus_->Publish(task));
  }
  loop_.Run();
  EXPECT_EQ(Agreeable::tasks, (std::vector<std::string>{"first", "second"}));
}

TEST_F(ServiceTest, SeveralFrontEndsHaveNamesOfTheirOwn) {
  Service service({.user = "ann", .device = "desk", .exit_after_sessions = 0}, *bus_, loop_, clock_,
                  steady_);
  ASSERT_TRUE(service.Add(*Factory("agreeable")));
  ASSERT_TRUE(service.Add(*Factory("agreeable")));
  service.Begin();
  loop_.Run();
  EXPECT_THAT(devices_, IsSupersetOf({"desk", "desk.agreeable"}));
}

TEST_F(ServiceTest, RefusesASimulatedUserThatWantsNothing) {
  Service service({.user = "ann", .device = "", .exit_after_sessions = 0}, *bus_, loop_, clock_,
                  steady_);
  const auto added = service.Add(*Factory("simulated"));
  ASSERT_FALSE(added);
  EXPECT_NE(added.error().message.find("ACTION:CATEGORY"), std::string::npos);
}

}  // namespace
}  // namespace beckon::ui_bridge
