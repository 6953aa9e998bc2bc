#include "services/ui_bridge/switch/input_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/ui_bridge/switch/fifo_switch.h"

namespace beckon::ui_bridge {
namespace {

using Bytes = std::vector<uint8_t>;

Bytes Join(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

Bytes Key(int code, int value, int64_t at_us = 0) {
  static int64_t stamp_us = 1'700'000'000'123'457;
  if (at_us == 0) at_us = stamp_us += 70'001;
  return Join({EventBytes(EV_MSC, MSC_SCAN, 458796, at_us), EventBytes(EV_KEY, code, value, at_us),
               EventBytes(EV_SYN, SYN_REPORT, 0, at_us)});
}

/// "+57 -57 !" for a press, a release, and a loss.
std::string Said(const std::vector<InputEvent>& events) {
  std::string said;
  for (const auto& event : events) {
    said += said.empty() ? "" : " ";
    said += event.kind == InputEvent::Kind::kLost
                ? "!"
                : (event.down ? "+" : "-") + std::to_string(event.code);
  }
  return said;
}

TEST(InputStream, TellsPressesReleasesAndTheirStamps) {
  InputStream stream;
  const auto events =
      stream.Feed(Join({Key(KEY_SPACE, 1, 5'000'001), Key(BTN_0, 1), Key(KEY_SPACE, 0)}));
  EXPECT_EQ(Said(events), "+57 +256 -57");
  EXPECT_EQ(events[0].device_us, 5'000'001);
  EXPECT_EQ(stream.garbage(), 0);
}

TEST(InputStream, TakesAKeysRepetitionsForNoPresses) {
  InputStream stream;
  EXPECT_EQ(Said(stream.Feed(Join({Key(57, 1), Key(57, 2), Key(57, 2), Key(57, 0)}))), "+57 -57");
}

TEST(InputStream, DoesNotMindWhereReadsEnd) {
  const Bytes bytes = Join({Key(57, 1), Key(57, 0), Key(28, 1), Key(28, 0)});
  std::mt19937 engine(1);
  for (int round = 0; round < 500; ++round) {
    InputStream stream;
    std::vector<InputEvent> events;
    for (size_t at = 0; at < bytes.size();) {
      const size_t n = std::min<size_t>(bytes.size() - at, 1 + engine() % 50);
      for (const auto& event : stream.Feed(std::span(bytes).subspan(at, n)))
        events.push_back(event);
      at += n;
    }
    ASSERT_EQ(Said(events), "+57 -57 +28 -28");
  }
}

TEST(InputStream, TellsThatEventsWereLostAndLeavesOutWhatComesUpToTheReport) {
  InputStream stream;
  const Bytes bytes =
      Join({Key(57, 1), EventBytes(EV_SYN, SYN_DROPPED, 0), EventBytes(EV_KEY, 57, 0),
            EventBytes(EV_SYN, SYN_REPORT, 0), Key(57, 1), Key(57, 0)});
  EXPECT_EQ(Said(stream.Feed(bytes)), "+57 ! +57 -57");
}

TEST(InputStream, ForgetsHalfAnEventWhenTheStreamBeginsAnew) {
  InputStream stream;
  const Bytes press = Key(57, 1);
  EXPECT_EQ(Said(stream.Feed(std::span(press).first(press.size() - 30))), "");
  stream.Reset();
  EXPECT_EQ(Said(stream.Feed(Join({Key(28, 1), Key(28, 0)}))), "+28 -28");
  EXPECT_EQ(stream.garbage(), 0);
}

TEST(InputStream, FindsItsWayBackAfterAStreamThatWasCutInTheMiddleOfAnEvent) {
  const Bytes press = Key(57, 1);
  for (size_t cut = 1; cut < press.size(); ++cut) {
    InputStream stream;
    Bytes bytes(press.begin() + static_cast<std::ptrdiff_t>(cut), press.end());
    for (int i = 0; i < 4; ++i) bytes = Join({bytes, Key(28, 1), Key(28, 0)});
    EXPECT_THAT(Said(stream.Feed(bytes)), ::testing::EndsWith("+28 -28 +28 -28"))
        << "cut at " << cut;
  }
}

TEST(InputStream, TakesGarbageForNoPressAndGoesOn) {
  for (unsigned seed = 0; seed < 500; ++seed) {
    std::mt19937 engine(seed);
    InputStream stream;
    Bytes garbage(engine() % 2000);
    for (uint8_t& byte : garbage) byte = static_cast<uint8_t>(engine());
    ASSERT_EQ(Said(stream.Feed(garbage)), "") << "seed " << seed;
    // What is left of it may swallow up to two events.
    Bytes bytes;
    for (int i = 0; i < 4; ++i) bytes = Join({bytes, Key(57, 1), Key(57, 0)});
    ASSERT_THAT(Said(stream.Feed(bytes)), ::testing::EndsWith("+57 -57 +57 -57"))
        << "seed " << seed;
    ASSERT_GT(stream.garbage() + 24, static_cast<int64_t>(garbage.size()) - 24);
  }
}

TEST(InputStream, SurvivesAnyBytesThatLookAlmostRight) {
  for (unsigned seed = 0; seed < 500; ++seed) {
    std::mt19937 engine(seed);
    InputStream stream;
    for (int i = 0; i < 100; ++i) {
      Bytes bytes = EventBytes(static_cast<int>(engine() % 40), static_cast<int>(engine() % 1000),
                               static_cast<int>(engine() % 5) - 1);
      if (engine() % 4 == 0) bytes[engine() % bytes.size()] ^= 1 << engine() % 8;
      if (engine() % 8 == 0) bytes.resize(engine() % bytes.size());
      for (const auto& event : stream.Feed(bytes)) {
        ASSERT_GE(event.code, 0);
        ASSERT_LE(event.code, KEY_MAX);
      }
    }
  }
}

}  // namespace
}  // namespace beckon::ui_bridge
