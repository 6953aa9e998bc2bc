// A device on a real FIFO and a real loop; and, where the machine can make one, a virtual device.
#include "services/ui_bridge/switch/event_device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/uinput.h>
#include <sys/ioctl.h>

#include <functional>
#include <random>

#include "tests/ui_bridge/switch/fifo_switch.h"

namespace beckon::ui_bridge {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Listener final : public SwitchListener {
 public:
  void OnEdge(Utime at, scan::Switch which, bool down) override {
    Add((down ? "+" : "-") + std::string(which == scan::Switch::kMain ? "m" : "s"));
    times.push_back(at);
  }
  void OnClick(Utime, scan::Switch) override { Add("click"); }
  void OnStopKey() override { Add("stop"); }
  void OnRelease(Utime) override { Add("release"); }
  void OnSourceNotice(const std::string& text) override {
    notices.push_back(text);
    if (changed) changed();
  }

  std::vector<std::string> said;
  std::vector<Utime> times;
  std::vector<std::string> notices;
  std::function<void()> changed;

 private:
  void Add(const std::string& what) {
    said.push_back(what);
    if (changed) changed();
  }
};

class EventDeviceTest : public ::testing::Test {
 protected:
  EventDeviceTest() {
    config_.device = fifo_.path();
    config_.main = {KeyChoice::kAny};
    config_.first_retry_us = 5'000;
    listener_.changed = [this] {
      if (until_ && until_()) loop_.Stop();
    };
  }

  void Start() {
    device_ = MakeEventDevice(config_, loop_, listener_);
    device_->Start();
  }
  /// Runs the loop until it holds, for at most 10 s.
  void Await(std::function<bool()> until) {
    until_ = std::move(until);
    if (!until_()) {
      const auto timer = loop_.After(10 * kSecond, [this] {
        ADD_FAILURE() << "not within 10 s; said " << listener_.said.size();
        loop_.Stop();
      });
      loop_.Run();
      loop_.Cancel(timer);
    }
    until_ = nullptr;
  }
  void AwaitSaid(size_t n) {
    Await([this, n] { return listener_.said.size() >= n; });
  }

  FifoSwitch fifo_;
  EventDeviceConfig config_;
  RunLoop loop_;
  Listener listener_;
  std::unique_ptr<SwitchSource> device_;
  std::function<bool()> until_;
};

TEST_F(EventDeviceTest, TellsTheEdgesOfItsKeys) {
  config_.select = {KEY_ENTER};
  Start();
  ASSERT_TRUE(fifo_.Key(1));
  ASSERT_TRUE(fifo_.Key(2));
  ASSERT_TRUE(fifo_.Key(0));
  ASSERT_TRUE(fifo_.Key(1, KEY_ENTER));
  AwaitSaid(3);
  EXPECT_THAT(listener_.said, ElementsAre("+m", "-m", "+s"));
  EXPECT_TRUE(listener_.notices.empty());
  EXPECT_EQ(device_->State(), "ok");
}

TEST_F(EventDeviceTest, KeepsTheLengthOfAPressThatIsReadAtOnce) {
  Start();
  ASSERT_TRUE(fifo_.Key(1, KEY_SPACE, 1'000'000));
  ASSERT_TRUE(fifo_.Key(0, KEY_SPACE, 1'120'000));
  AwaitSaid(2);
  EXPECT_EQ(listener_.times[1] - listener_.times[0], 120'000);
}

TEST_F(EventDeviceTest, SaysThatItWentAndThatItIsBackAndLetsGoWhatWasHeld) {
  Start();
  for (int round = 0; round < 3; ++round) {
    listener_.said.clear();
    listener_.notices.clear();
    ASSERT_TRUE(fifo_.Key(1));
    AwaitSaid(1);
    fifo_.Unplug();
    Await([this] { return listener_.said.back() == "release" && !listener_.notices.empty(); });
    EXPECT_THAT(listener_.notices.back(), HasSubstr("not there"));
    EXPECT_NE(device_->State(), "ok");
    const auto again = loop_.Every(2'000, [this] {
      if (fifo_.Plug()) loop_.Stop();
    });
    loop_.Run();
    loop_.Cancel(again);
    ASSERT_TRUE(fifo_.Key(1, KEY_A));
    ASSERT_TRUE(fifo_.Key(0, KEY_A));
    Await([this] { return listener_.said.back() == "-m"; });
    EXPECT_EQ(listener_.notices.back(), "The switch is back.");
    EXPECT_EQ(device_->State(), "ok");
  }
}

TEST_F(EventDeviceTest, WaitsForADeviceThatIsNotThereYet) {
  FifoSwitch later;
  config_.device = later.path() + ".later";
  Start();
  ASSERT_EQ(listener_.notices.size(), 1u);
  EXPECT_THAT(listener_.notices[0], HasSubstr(config_.device));
  std::filesystem::create_symlink(later.path(), config_.device);
  const auto again = loop_.Every(2'000, [&] {
    if (later.Plug()) loop_.Stop();
  });
  loop_.Run();
  loop_.Cancel(again);
  ASSERT_TRUE(later.Key(1));
  AwaitSaid(1);
  EXPECT_EQ(listener_.notices.size(), 2u);
}

TEST_F(EventDeviceTest, RefusesWhatIsNoDevice) {
  config_.device = "/etc/passwd";
  Start();
  ASSERT_EQ(listener_.notices.size(), 1u);
  EXPECT_THAT(listener_.notices[0], HasSubstr("expected an input device or a FIFO"));
  device_.reset();
  config_.device = "name:No such switch";
  Start();
  EXPECT_THAT(listener_.notices.back(), HasSubstr("No such switch"));
}

TEST_F(EventDeviceTest, GoesOnAfterGarbageAndAfterAnEventThatWasCut) {
  Start();
  const std::vector<uint8_t> garbage(1001, 0xA5);
  ASSERT_TRUE(fifo_.Write(garbage));
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(fifo_.Key(1));
    ASSERT_TRUE(fifo_.Key(0));
  }
  AwaitSaid(4);
  EXPECT_THAT(device_->State(), HasSubstr("odd bytes"));
  auto half = EventBytes(EV_KEY, KEY_SPACE, 1);
  half.resize(11);
  ASSERT_TRUE(fifo_.Write(half));
  fifo_.Unplug();
  Await([this] { return listener_.said.back() == "release"; });
  const auto again = loop_.Every(2'000, [this] {
    if (fifo_.Plug()) loop_.Stop();
  });
  loop_.Run();
  loop_.Cancel(again);
  ASSERT_TRUE(fifo_.Key(1));
  Await([this] { return listener_.said.back() == "+m"; });
}

TEST_F(EventDeviceTest, LetsGoWhatWasHeldWhereEventsWereLost) {
  Start();
  ASSERT_TRUE(fifo_.Key(1));
  ASSERT_TRUE(fifo_.Write(EventBytes(EV_SYN, SYN_DROPPED, 0)));
  ASSERT_TRUE(fifo_.Write(EventBytes(EV_SYN, SYN_REPORT, 0)));
  AwaitSaid(2);
  EXPECT_THAT(listener_.said, ElementsAre("+m", "release"));
}

/// Any bytes at all on the stream, in pieces, with the writer going away in between.
TEST_F(EventDeviceTest, SurvivesAnyBytes) {
  Start();
  std::mt19937 engine(4);
  int written = 0;
  const auto timer = loop_.Every(200, [&] {
    std::vector<uint8_t> bytes(1 + engine() % 300);
    for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(engine() % 3 == 0 ? engine() : 0);
    if (fifo_.Write(bytes)) ++written;
    if (engine() % 20 == 0) fifo_.Unplug();
    if (written >= 500) loop_.Stop();
  });
  loop_.Run();
  loop_.Cancel(timer);
  fifo_.Unplug();
  listener_.said.clear();
  const auto again = loop_.Every(2'000, [&] {
    if (fifo_.Plug()) {
      fifo_.Key(1);
      fifo_.Key(0);
    }
  });
  Await([this] { return !listener_.said.empty() && listener_.said.back() == "-m"; });
  loop_.Cancel(again);
}

TEST_F(EventDeviceTest, ReadsAVirtualDeviceByItsName) {
  const int fd = open("/dev/uinput", O_WRONLY | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) GTEST_SKIP() << "/dev/uinput cannot be opened on this machine: " << strerror(errno);
  uinput_setup setup{};
  std::strcpy(setup.name, "Beckon test switch");
  setup.id = {.bustype = BUS_VIRTUAL, .vendor = 1, .product = 1, .version = 1};
  ioctl(fd, UI_SET_EVBIT, EV_KEY);
  ioctl(fd, UI_SET_KEYBIT, BTN_0);
  ASSERT_EQ(ioctl(fd, UI_DEV_SETUP, &setup), 0);
  ASSERT_EQ(ioctl(fd, UI_DEV_CREATE), 0);
  config_.device = "name:Beckon test switch";
  config_.grab = true;
  Start();
  const auto timer = loop_.Every(50'000, [&] {
    for (const int value : {1, 0}) {
      for (const auto& bytes :
           {EventBytes(EV_KEY, BTN_0, value), EventBytes(EV_SYN, SYN_REPORT, 0)}) {
        ASSERT_EQ(write(fd, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
      }
    }
  });
  AwaitSaid(2);
  EXPECT_EQ(listener_.said[0], "+m");
  ioctl(fd, UI_DEV_DESTROY);
  loop_.Cancel(timer);
  Await([this] { return listener_.said.back() == "release"; });
  close(fd);
}

}  // namespace
}  // namespace beckon::ui_bridge
