#include "services/base/bus.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>

#include <lcm/lcm-cpp.hpp>

#include "tests/base/trust/temporary_keys.h"

namespace beckon {
namespace {

/// Handles one message, waiting for it.
void HandleOne(Bus& bus) {
  pollfd fd{.fd = bus.fd(), .events = POLLIN, .revents = 0};
  ASSERT_EQ(poll(&fd, 1, 5000), 1) << "nothing arrived";
  bus.HandleReadable();
}

msg::TaskStatus Example() {
  return {.utime = 5, .task_id = "t", .state = msg::TaskState::kDone, .text = "done", .seal = {}};
}

TEST(Bus, DeliversWhatWasPublished) {
  auto bus = *Bus::Open("memq://");
  std::vector<msg::TaskStatus> got;
  bus->Subscribe<msg::TaskStatus>(
      [&](msg::TaskStatus status) { got.push_back(std::move(status)); });
  ASSERT_TRUE(bus->Publish(Example()).ok());
  HandleOne(*bus);
  ASSERT_EQ(got.size(), 1u);
  EXPECT_EQ(got[0].text, "done");
  EXPECT_EQ(bus->refused(), 0);
}

TEST(Bus, RefusesToPublishWhatBreaksTheRules) {
  auto bus = *Bus::Open("memq://");
  msg::TaskStatus status = Example();
  status.utime = 0;
  EXPECT_FALSE(bus->Publish(status).ok());
}

TEST(Bus, SurvivesAHandlerThatThrows) {
  auto bus = *Bus::Open("memq://");
  int calls = 0;
  bus->Subscribe<msg::TaskStatus>([&](const msg::TaskStatus&) {
    if (++calls == 1) throw std::runtime_error("broken");
  });
  ASSERT_TRUE(bus->Publish(Example()).ok());
  ASSERT_TRUE(bus->Publish(Example()).ok());
  HandleOne(*bus);
  HandleOne(*bus);
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(bus->refused(), 1);
  EXPECT_EQ(bus->traffic().at("BECKON_TASK_STATUS").refused.at("handler"), 1);
}

TEST(Bus, CountsEachChannelsTrafficAndWhyMessagesWereRefused) {
  auto bus = *Bus::Open("memq://");
  bus->Subscribe<msg::TaskStatus>([](const msg::TaskStatus&) {});
  ASSERT_TRUE(bus->Publish(Example()).ok());
  HandleOne(*bus);
  bus->Refuse("BECKON_TASK_STATUS", refusal::kStale, "of another task");
  bus->Refuse("BECKON_TASK_STATUS", refusal::kStale, "of another task");
  bus->Refuse("BECKON_ANSWER", refusal::kUnknown, "to no query");
  const ChannelTraffic& traffic = bus->traffic().at("BECKON_TASK_STATUS");
  EXPECT_EQ(traffic.sent, 1);
  EXPECT_EQ(traffic.received, 1);
  EXPECT_GT(traffic.received_bytes, 0);
  EXPECT_EQ(traffic.received_bytes, traffic.sent_bytes);
  EXPECT_EQ(traffic.refused.at("stale"), 2);
  EXPECT_EQ(bus->refused(), 3);
}

TEST(Bus, MeasuresTheAgeOfStreamsUntilTheirHandling) {
  auto bus = *Bus::Open("memq://");
  bus->Subscribe<msg::Scene>([](const msg::Scene&) {});
  msg::Scene scene;
  scene.source = "somewhere";
  scene.width = 4;
  scene.height = 3;
  scene.intrinsics = {.fx = 500, .fy = 500, .cx = 2, .cy = 1};
  for (int64_t seq : {1, 4}) {
    scene.seq = scene.frame_seq = seq;
    scene.utime = SystemClock().Now() - 3 * kSecond;
    const auto sent = bus->Publish(scene);
    ASSERT_TRUE(sent.ok()) << sent.error().message;
    HandleOne(*bus);
  }
  EXPECT_GE(bus->traffic().at("BECKON_SCENE").age_us_max, 3 * kSecond);
  EXPECT_EQ(bus->traffic().at("BECKON_SCENE").lost, 2);
  bus->ForgetPeaks();
  EXPECT_EQ(bus->traffic().at("BECKON_SCENE").age_us_max, 0);
  EXPECT_EQ(bus->traffic().at("BECKON_SCENE").lost, 2);
}

TEST(Bus, ASignedOneBelievesItselfAndNobodyUnsigned) {
  const trust::TemporaryKeys keys("kitchen");
  const SystemClock clock;
  const SteadyClock steady;
  auto bus = *Bus::Open("memq://", std::make_unique<trust::Guard>(
                                       keys.folder(), **keys.folder().Own(), "", clock, steady));
  std::vector<msg::TaskStatus> got;
  bus->Subscribe<msg::TaskStatus>(
      [&](msg::TaskStatus status) { got.push_back(std::move(status)); });
  ASSERT_TRUE(bus->Publish(Example()).ok());
  HandleOne(*bus);
  ASSERT_EQ(got.size(), 1u);
  EXPECT_EQ(got[0].seal.sender, "kitchen");
  EXPECT_EQ(bus->refused(), 0);
}

TEST(Bus, ASignedOneServesSeveralHandlersOfAType) {
  const trust::TemporaryKeys keys("kitchen");
  const SystemClock clock;
  const SteadyClock steady;
  auto bus = *Bus::Open("memq://", std::make_unique<trust::Guard>(
                                       keys.folder(), **keys.folder().Own(), "", clock, steady));
  std::vector<std::string> heard;
  for (const char* name : {"first", "second"}) {
    bus->Subscribe<msg::TaskStatus>(
        [&heard, name](const msg::TaskStatus& status) { heard.push_back(name + status.text); });
  }
  ASSERT_TRUE(bus->Publish(Example()));
  HandleOne(*bus);
  EXPECT_THAT(heard, ::testing::ElementsAre("firstdone", "seconddone"));
  EXPECT_EQ(bus->refused(), 0);
  EXPECT_EQ(bus->received(), 1);
}

TEST(Bus, AHandlerThatThrowsDoesNotKeepAMessageFromTheNext) {
  auto bus = *Bus::Open("memq://");
  int heard = 0;
  bus->Subscribe<msg::TaskStatus>(
      [](const msg::TaskStatus&) { throw std::runtime_error("broken"); });
  bus->Subscribe<msg::TaskStatus>([&](const msg::TaskStatus&) { ++heard; });
  ASSERT_TRUE(bus->Publish(Example()));
  HandleOne(*bus);
  EXPECT_EQ(heard, 1);
  EXPECT_EQ(bus->traffic().at("BECKON_TASK_STATUS").refused.at("handler"), 1);
}

TEST(Bus, CountersOfSealsGrowWithoutKeysToo) {
  auto bus = *Bus::Open("memq://");
  std::vector<int64_t> counters;
  bus->Subscribe<msg::TaskStatus>(
      [&](const msg::TaskStatus& status) { counters.push_back(status.seal.counter); });
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(bus->Publish(Example()).ok());
    HandleOne(*bus);
  }
  EXPECT_LT(counters[0], counters[1]);
}

TEST(Bus, SaysWhatIsWrongWithAnUrl) {
  const auto bus = Bus::Open("carrier-pigeon://");
  ASSERT_FALSE(bus.ok());
  EXPECT_THAT(bus.error().message, ::testing::HasSubstr("carrier-pigeon://"));
}

}  // namespace
}  // namespace beckon
