// The whole service in this process, over LCM's memory bus.
#include "services/intention/service.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "lcmtypes/codec.h"
#include "services/intention/store.h"
#include "tests/intention/temporary_folder.h"

namespace beckon::intention {
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

/// Perception, a front end and a robot around the service, all on one bus.
class ServiceTest : public testing::Test {
 protected:
  void SetUp() override {
    auto opened = Bus::Open("memq://");
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    bus = *std::move(opened);
    loop.AddFd(bus->fd(), [this] { bus->HandleReadable(); });
    config.db = folder / "beckon.db";
    config.affordances = std::string(BECKON_SOURCE_DIR) + "/services/intention/affordances.toml";
    config.machine = "kitchen";
    bus->Subscribe<msg::Query>([this](msg::Query query) { OnQuery(query); });
    bus->Subscribe<msg::Task>([this](msg::Task task) {
      tasks.push_back(task);
      if (acknowledge)
        Send(msg::TaskStatus{clock.Now(), task.task_id, msg::TaskState::kAccepted, "", {}});
    });
    bus->Subscribe<msg::Session>([this](msg::Session event) { OnEvent(event); });
    bus->Subscribe<msg::Status>([this](msg::Status status) {
      last_status = status;
      if (stop_at_status) loop.Stop();
    });
  }

  template <typename T>
  void Send(const T& message) {
    const Status sent = bus->Publish(message);
    ASSERT_TRUE(sent.ok()) << sent.error().message;
  }
  void StartService() {
    auto started = Service::Start(config, *bus, loop, clock);
    ASSERT_TRUE(started.ok()) << started.error().message;
    service = *std::move(started);
  }
  void ShowScene() {
    msg::Scene scene;
    scene.utime = clock.Now();
    scene.seq = 1;
    scene.frame_seq = 1;
    scene.source = "test";
    scene.width = 640;
    scene.height = 480;
    scene.has_table = true;
    scene.objects = {Object(1, "Carton", 0, 0.5), Object(2, "Mug", 0.2, 0.4),
                     Object(3, "Mug", -0.2, 0.6)};
    Send(scene);
    msg::Interface interface;
    interface.utime = clock.Now();
    interface.device = "test";
    Send(interface);
  }
  void Request(const std::string& id, msg::SessionKind kind = msg::SessionKind::kRequestStart) {
    msg::Session request;
    request.utime = clock.Now();
    request.session_id = id;
    request.user = "ann";
    request.device = "test";
    request.kind = kind;
    Send(request);
  }
  /// Wants to drink from the second mug (object 3).
  void OnQuery(const msg::Query& query) {
    if (query.id == last_query) return;
    last_query = query.id;
    EXPECT_EQ(query.seal.sender, "kitchen/intention");
    EXPECT_GT(query.seal.counter, last_counter);
    last_counter = query.seal.counter;
    ++questions;
    const bool action =
        query.any_action || std::count(query.actions.begin(), query.actions.end(), "Drink") > 0;
    const bool object =
        query.any_object || std::any_of(query.objects.begin(), query.objects.end(),
                                        [](const auto& o) { return o.object_id == 3; });
    msg::Answer answer;
    answer.utime = clock.Now();
    answer.query_id = query.id;
    answer.session_id = query.session_id;
    answer.device = "test";
    answer.likelihoods = {action && object ? 1.0 : 0.0, action && object ? 0.0 : 1.0};
    if (hostile) SendHostile(answer);
    Send(answer);
    Send(answer);  // a duplicate
  }
  /// Well formed answers that must not be taken. All mean the opposite of `honest`.
  void SendHostile(msg::Answer honest) {
    std::swap(honest.likelihoods[0], honest.likelihoods[1]);
    msg::Answer longer = honest, query = honest, session = honest, huge = honest;
    longer.likelihoods.push_back(1);
    query.query_id += 1;
    session.session_id = "another";
    huge.likelihoods.assign(64, 1e12);
    for (const msg::Answer& answer : {longer, query, session, huge}) Send(answer);
    hostile_sent += 4;
  }
  int64_t Counter(const std::string& name) const {
    for (const auto& c : last_status.counters) {
      if (c.name == name) return c.value;
    }
    return -1;
  }
  void OnEvent(const msg::Session& event) {
    if (event.kind < msg::SessionKind::kIdle) return;
    last_event = event;
    if (event.kind == stop_at) loop.Stop();
  }
  void RunUntil(msg::SessionKind kind) {
    stop_at = kind;
    const auto timeout = loop.After(20 * kSecond, [this] {
      ADD_FAILURE() << "timeout";
      loop.Stop();
    });
    loop.Run();
    loop.Cancel(timeout);
  }

  TemporaryFolder folder;
  SystemClock clock;
  RunLoop loop;
  std::unique_ptr<Bus> bus;
  ServiceConfig config;
  std::unique_ptr<Service> service;
  std::vector<msg::Task> tasks;
  msg::Session last_event;
  msg::Status last_status;
  msg::SessionKind stop_at = msg::SessionKind::kRequestStart;
  bool acknowledge = true;
  bool hostile = false;
  int hostile_sent = 0;
  bool stop_at_status = false;
  int64_t last_query = 0;
  int64_t last_counter = 0;
  int questions = 0;
};

TEST_F(ServiceTest, HoldsAConversationToTheTask) {
  StartService();
  ShowScene();
  Request("s1");
  RunUntil(msg::SessionKind::kConfirmed);
  ASSERT_FALSE(tasks.empty());
  EXPECT_EQ(tasks[0].action, "Drink");
  EXPECT_EQ(tasks[0].object.object_id, 3);
  EXPECT_EQ(tasks[0].object.instance, 2);
  EXPECT_EQ(tasks[0].questions, questions);
  EXPECT_EQ(last_event.text, "Drink from the second mug.");
  const int first = questions;
  ShowScene();
  Request("s2");
  while (last_event.session_id != "s2") RunUntil(msg::SessionKind::kConfirmed);
  EXPECT_LT(questions - first, first);
  stop_at_status = true;
  RunUntil(msg::SessionKind::kRequestStart);
  EXPECT_EQ(last_status.service, "intention");
  EXPECT_EQ(Counter("confirmed"), 2);
  EXPECT_EQ(Counter("answers"), questions);
  EXPECT_EQ(Counter("stale_answers"), questions);  // the duplicates
  EXPECT_EQ(Counter("db_rows"), 2);
  EXPECT_GT(Counter("question_us"), 0);
}

TEST_F(ServiceTest, HostileAnswersAreRefusedAndCountedAndItLivesOn) {
  hostile = true;
  StartService();
  ShowScene();
  Request("s1");
  RunUntil(msg::SessionKind::kConfirmed);
  ASSERT_FALSE(tasks.empty());
  EXPECT_EQ(tasks[0].action, "Drink");
  EXPECT_EQ(tasks[0].object.object_id, 3);
  stop_at_status = true;
  RunUntil(msg::SessionKind::kRequestStart);
  EXPECT_EQ(Counter("answers"), questions);
  EXPECT_EQ(Counter("stale_answers") + Counter("refused_requests"), hostile_sent + questions);
}

TEST_F(ServiceTest, LikelihoodsThatAreNoneReachNobody) {
  msg::Answer answer;
  answer.utime = clock.Now();
  answer.query_id = 1;
  answer.session_id = "s1";
  answer.device = "test";
  answer.likelihoods = {0.25, 0.75};
  const auto good = Codec<msg::Answer>::Encode(answer);
  ASSERT_TRUE(good.ok());
  EXPECT_TRUE(Codec<msg::Answer>::Decode(*good).ok());
  const std::array<uint8_t, 8> quarter{0x3f, 0xd0, 0, 0, 0, 0, 0, 0};
  const auto at = std::search(good->begin(), good->end(), quarter.begin(), quarter.end());
  ASSERT_NE(at, good->end());
  for (const double bad : {-1.0, std::nan(""), -std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::infinity(), 1e300}) {
    answer.likelihoods[0] = bad;
    EXPECT_FALSE(bus->Publish(answer).ok()) << bad;
    auto bytes = *good;
    uint64_t bits;
    std::memcpy(&bits, &bad, sizeof bits);
    for (int i = 0; i < 8; ++i)
      bytes[static_cast<size_t>(at - good->begin() + i)] =
          static_cast<uint8_t>(bits >> (56 - 8 * i));
    EXPECT_FALSE(Codec<msg::Answer>::Decode(bytes).ok()) << bad;
  }
}

TEST_F(ServiceTest, PublishesAnOpenTaskAfterARestart) {
  acknowledge = false;
  StartService();
  ShowScene();
  Request("s1");
  RunUntil(msg::SessionKind::kConfirmed);
  ASSERT_FALSE(tasks.empty());
  service.reset();
  // What the first one subscribed to must not be called any more: a bus of its own.
  bus.reset();
  auto opened = Bus::Open("memq://");
  ASSERT_TRUE(opened.ok());
  auto second_bus = *std::move(opened);
  RunLoop second_loop;
  second_loop.AddFd(second_bus->fd(), [&] { second_bus->HandleReadable(); });
  msg::Task again;
  second_bus->Subscribe<msg::Task>([&](msg::Task task) {
    again = task;
    second_loop.Stop();
  });
  auto second = Service::Start(config, *second_bus, second_loop, clock);
  ASSERT_TRUE(second.ok()) << second.error().message;
  second_loop.After(20 * kSecond, [&] { second_loop.Stop(); });
  second_loop.Run();
  EXPECT_EQ(again.task_id, "s1");
  EXPECT_EQ(again.object.object_id, 3);
}

TEST_F(ServiceTest, SaysWhatIsWrongWithItsFiles) {
  config.db = "/dev/null/beckon.db";
  auto started = Service::Start(config, *bus, loop, clock);
  ASSERT_FALSE(started.ok());
  EXPECT_NE(started.error().message.find("/dev/null"), std::string::npos);
  config.db = folder / "ok.db";
  config.affordances = folder / "absent.toml";
  EXPECT_FALSE(Service::Start(config, *bus, loop, clock).ok());
}

}  // namespace
}  // namespace beckon::intention
