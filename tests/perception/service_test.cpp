// The service on an in-process bus.
#include "services/perception/service.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/frame_image.h"
#include "tests/perception/box_world.h"

namespace beckon::perception {
namespace {

class ServiceTest : public testing::Test {
 protected:
  void SetUp() override {
    auto bus = Bus::Open("memq://");
    ASSERT_TRUE(bus) << bus.error().message;
    bus_ = *std::move(bus);
    loop_.AddFd(bus_->fd(), [this] { bus_->HandleReadable(); });
    bus_->Subscribe<msg::Scene>([this](msg::Scene scene) {
      scenes_.push_back(std::move(scene));
      if (scenes_.size() >= expected_) loop_.Stop();
    });
    bus_->Subscribe<msg::Status>([this](msg::Status status) {
      statuses_.push_back(std::move(status));
      if (wait_for_status_) loop_.Stop();
    });
    service_ = std::make_unique<Service>(*bus_, loop_, PerceiverConfig{}, std::nullopt);
  }

  msg::Frame FrameOf(const RgbdImage& image, int64_t seq) {
    msg::Frame frame;
    frame.utime = 1'000'000 * seq;
    frame.seq = seq;
    frame.source = "test";
    EXPECT_TRUE(EncodeImage(image, 0.0001, 90, frame));
    return frame;
  }

  /// Publishes and waits until so many scenes came in all, or ten seconds.
  void PublishAndWait(const msg::Frame& frame, size_t scenes) {
    expected_ = scenes;
    ASSERT_TRUE(bus_->Publish(frame));
    WaitForStop();
    ASSERT_EQ(scenes_.size(), scenes);
  }

  void WaitForStop() {
    const auto timer = loop_.After(10 * kSecond, [this] { loop_.Stop(); });
    loop_.Run();
    loop_.Cancel(timer);
  }

  /// Runs until the next status.
  msg::Status NextStatus() {
    wait_for_status_ = true;
    statuses_.clear();
    WaitForStop();
    wait_for_status_ = false;
    return statuses_.empty() ? msg::Status{} : statuses_.back();
  }

  static int64_t Count(const msg::Status& status, const std::string& name) {
    for (const auto& counter : status.counters) {
      if (counter.name == name) return counter.value;
    }
    return -1;
  }

  RunLoop loop_;
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<Service> service_;
  std::vector<msg::Scene> scenes_;
  std::vector<msg::Status> statuses_;
  size_t expected_ = 0;
  bool wait_for_status_ = false;
};

TEST_F(ServiceTest, AFrameInGivesASceneOut) {
  EXPECT_EQ(service_->state(), "no frame yet");
  PublishAndWait(FrameOf(ThreeBoxes().Render(), 7), 1);
  const msg::Scene& scene = scenes_[0];
  EXPECT_TRUE(scene.has_table);
  EXPECT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(scene.utime, 7'000'000);
  EXPECT_EQ(scene.frame_seq, 7);
  EXPECT_EQ(scene.seq, 1);
  EXPECT_EQ(scene.source, "test");
  EXPECT_EQ(scene.width, 320);
  EXPECT_EQ(scene.intrinsics.fx, ThreeBoxes().Render().intrinsics.fx);
  for (const auto& object : scene.objects) EXPECT_FALSE(object.rim_C.empty());
  EXPECT_GT(scene.segmentation_ms, 0);
  EXPECT_EQ(service_->state(), "3 objects");
}

TEST_F(ServiceTest, ARepeatedImageIsNotComputedAgainButPublishedAnew) {
  const RgbdImage image = ThreeBoxes().Render();
  PublishAndWait(FrameOf(image, 1), 1);
  PublishAndWait(FrameOf(image, 2), 2);
  EXPECT_EQ(scenes_[1].seq, 2);
  EXPECT_EQ(scenes_[1].frame_seq, 2);
  EXPECT_EQ(scenes_[1].utime, 2'000'000);
  EXPECT_EQ(scenes_[1].objects.size(), 3u);
  EXPECT_EQ(service_->counters().computed, 1);
  EXPECT_EQ(service_->counters().repeated, 1);
}

TEST_F(ServiceTest, ObjectsKeepTheirIdsWhereTheyMoveALittle) {
  BoxWorld world = ThreeBoxes();
  PublishAndWait(FrameOf(world.Render(), 1), 1);
  world.boxes[2].low.x() += 0.015;
  world.boxes[2].high.x() += 0.015;
  PublishAndWait(FrameOf(world.Render(), 2), 2);
  EXPECT_EQ(service_->counters().computed, 2);
  std::vector<int> first, second;
  for (const auto& object : scenes_[0].objects) first.push_back(object.id);
  for (const auto& object : scenes_[1].objects) second.push_back(object.id);
  EXPECT_THAT(second, testing::UnorderedElementsAreArray(first));
}

TEST_F(ServiceTest, ADamagedFrameIsCountedAndTheNextOneServed) {
  msg::Frame damaged = FrameOf(ThreeBoxes().Render(), 1);
  damaged.depth.resize(damaged.depth.size() / 2);
  for (size_t i = 20; i < damaged.depth.size(); i += 3) damaged.depth[i] ^= 0x5a;
  ASSERT_TRUE(bus_->Publish(damaged));
  expected_ = 1;
  const auto poll = loop_.Every(2000, [this] {
    if (service_->counters().damaged > 0) loop_.Stop();
  });
  WaitForStop();
  loop_.Cancel(poll);
  EXPECT_EQ(service_->counters().damaged, 1);
  EXPECT_EQ(bus_->refused(), 1);
  PublishAndWait(FrameOf(ThreeBoxes().Render(), 3), 1);
}

TEST_F(ServiceTest, WithoutATableSaysWhyAndPublishesAnEmptyScene) {
  BoxWorld world;
  world.pitch_deg = 5;
  world.boxes = {{{-3, 1.5, -1}, {3, 1.6, 3}}};
  PublishAndWait(FrameOf(world.Render(), 1), 1);
  EXPECT_FALSE(scenes_[0].has_table);
  EXPECT_TRUE(scenes_[0].objects.empty());
  EXPECT_THAT(service_->state(), testing::StartsWith("no table in view: "));
}

TEST_F(ServiceTest, ReportsHowItFares) {
  PublishAndWait(FrameOf(ThreeBoxes().Render(), 1), 1);
  const msg::Status status = NextStatus();
  EXPECT_EQ(status.service, "perception");
  EXPECT_EQ(status.state, "3 objects");
  EXPECT_EQ(Count(status, "frames"), 1);
  EXPECT_EQ(Count(status, "scenes"), 1);
  EXPECT_EQ(Count(status, "objects"), 3);
  EXPECT_EQ(Count(status, "dropped"), 0);
  EXPECT_GT(Count(status, "segmentation_us"), 0);
}

TEST_F(ServiceTest, EndsWhileAFrameIsAtWork) {
  ASSERT_TRUE(bus_->Publish(FrameOf(ThreeBoxes().Render(), 1)));
  loop_.After(1, [this] { loop_.Stop(); });
  loop_.Run();
  service_.reset();  // joins; what it posted later is left undone
  loop_.After(1000, [this] { loop_.Stop(); });
  loop_.Run();
  EXPECT_LE(scenes_.size(), 1u);
}

}  // namespace
}  // namespace beckon::perception
