#include "services/base/status_counters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>

#include "services/base/refusal.h"
#include "services/base/status_reporter.h"

namespace beckon {
namespace {

std::optional<int64_t> Value(const std::vector<msg::Counter>& counters, const std::string& name) {
  const auto found = std::ranges::find(counters, name, &msg::Counter::name);
  return found == counters.end() ? std::nullopt : std::optional(found->value);
}

TEST(ChannelTraffic, CountsWhatIsMissingBetweenNumbers) {
  ChannelTraffic traffic;
  for (int64_t seq : {5, 6, 9, 10}) traffic.NoteSeq(seq);
  EXPECT_EQ(traffic.lost, 2);
}

TEST(ChannelTraffic, TakesARestartedOrLeapingSenderForNoLoss) {
  ChannelTraffic traffic;
  for (int64_t seq : std::initializer_list<int64_t>{5'000, 1, 2, 1'000'000, 1'000'001, INT64_MAX,
                                                    INT64_MIN, INT64_MAX})
    traffic.NoteSeq(seq);
  EXPECT_EQ(traffic.lost, 0);
}

TEST(StatusCounters, TellsRatesSinceTheLast) {
  StatusCounters status(0);
  BusTraffic traffic;
  traffic["BECKON_SCENE"].received = 60;
  traffic["BECKON_POSES"].sent = 30;
  auto counters = status.Take(traffic, {.cpu_ms = 500}, 2 * kSecond);
  EXPECT_EQ(Value(counters, "received_per_s"), 30);
  EXPECT_EQ(Value(counters, "sent_per_s"), 15);
  EXPECT_EQ(Value(counters, "cpu_percent"), 25);
  traffic["BECKON_SCENE"].received = 70;
  counters = status.Take(traffic, {.cpu_ms = 600}, 3 * kSecond);
  EXPECT_EQ(Value(counters, "received"), 70);
  EXPECT_EQ(Value(counters, "received_per_s"), 10);
  EXPECT_EQ(Value(counters, "sent_per_s"), 0);
  EXPECT_EQ(Value(counters, "cpu_ms"), 600);
  EXPECT_EQ(Value(counters, "cpu_percent"), 10);
  EXPECT_EQ(Value(counters, "uptime_s"), 3);
}

TEST(StatusCounters, TellsRefusalsByChannelAndReason) {
  BusTraffic traffic;
  traffic["BECKON_ANSWER"].refused = {{refusal::kStale, 3}, {refusal::kMalformed, 1}};
  const auto counters = StatusCounters(0).Take(traffic, {}, kSecond);
  EXPECT_EQ(Value(counters, "refused"), 4);
  EXPECT_EQ(Value(counters, "refused.BECKON_ANSWER.stale"), 3);
  EXPECT_EQ(Value(counters, "refused.BECKON_ANSWER.malformed"), 1);
}

TEST(StatusCounters, TellsTheAgeOfStreamsAlone) {
  BusTraffic traffic;
  traffic["BECKON_SCENE"] = {.received = 1, .lost = 2, .age_us_max = 9, .newest_seq = 4};
  traffic["BECKON_ANSWER"] = {.received = 1, .wait_us_max = 5, .handler_us_max = 6};
  const auto counters = StatusCounters(0).Take(traffic, {}, kSecond);
  EXPECT_EQ(Value(counters, "age_us.BECKON_SCENE"), 9);
  EXPECT_EQ(Value(counters, "lost.BECKON_SCENE"), 2);
  EXPECT_EQ(Value(counters, "age_us.BECKON_ANSWER"), std::nullopt);
  EXPECT_EQ(Value(counters, "wait_us"), 5);
  EXPECT_EQ(Value(counters, "handler_us"), 6);
}

TEST(StatusCounters, NamesEachOnce) {
  BusTraffic traffic;
  traffic["BECKON_SCENE"] = {.received = 1, .sent = 1, .newest_seq = 1};
  std::set<std::string> names;
  for (const auto& counter : StatusCounters(0).Take(traffic, {}, kSecond))
    EXPECT_TRUE(names.insert(counter.name).second) << counter.name;
}

TEST(StatusCounters, AreAllDocumented) {
  std::ifstream file(BECKON_SOURCE_DIR "/docs/protocol.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  BusTraffic traffic;
  traffic["CHANNEL"] = {.received = 1, .sent = 1, .refused = {{"REASON", 1}}, .newest_seq = 1};
  for (const auto& counter : StatusCounters(0).Take(traffic, {}, kSecond))
    EXPECT_NE(text.find("`" + counter.name + "`"), std::string::npos) << counter.name;
}

TEST(ProcessUsage, IsOfThisProcess) {
  const auto usage = ProcessUsage::Now();
  EXPECT_GT(usage.rss_kb, 500);
  volatile double work = 0;
  while (ProcessUsage::Now().cpu_ms < usage.cpu_ms + 20) work = work + 1;
  EXPECT_GE(ProcessUsage::Now().rss_kb, 500);
}

TEST(StatusReporter, ReportsEverySecondEvenWithMoreCountersThanFit) {
  auto bus = *Bus::Open("memq://");
  RunLoop loop;
  loop.AddFd(bus->fd(), [&] { bus->HandleReadable(); });
  std::vector<msg::Status> heard;
  bus->Subscribe<msg::Status>([&](msg::Status status) {
    heard.push_back(std::move(status));
    if (heard.size() == 2) loop.Stop();
  });
  StatusReporter reporter("test", *bus, loop, [](msg::Status& status) {
    status.state = "busy";
    for (int i = 0; i < 500; ++i) status.counters.push_back({"own" + std::to_string(i), i});
  });
  const auto give_up = loop.After(20 * kSecond, [&] { loop.Stop(); });
  loop.Run();
  loop.Cancel(give_up);
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_EQ(heard[0].service, "test");
  EXPECT_EQ(heard[0].counters.size(), static_cast<size_t>(msg::kMaxCounters));
  EXPECT_EQ(Value(heard[0].counters, "sent"), 0);
  EXPECT_EQ(Value(heard[1].counters, "sent.BECKON_STATUS"), 1);
  EXPECT_EQ(Value(heard[1].counters, "received.BECKON_STATUS"), 1);
}

}  // namespace
}  // namespace beckon
