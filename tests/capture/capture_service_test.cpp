// The service on an in-process bus: frames follow each other and decode to what the source showed.
#include "services/capture/service.h"

#include <gtest/gtest.h>

#include <vector>

#include "lcmtypes/frame_image.h"

namespace beckon::capture {
namespace {

CapturedImage Image(const std::string& name, float depth_m) {
  auto image = std::make_shared<RgbdImage>();
  image->width = 64;
  image->height = 48;
  image->intrinsics = {60, 61, 32, 24};
  image->depth_m.assign(64 * 48, depth_m);
  image->depth_m[5] = 0;
  image->colour.assign(64 * 48, Rgb{10, 120, 200});
  return {image, name};
}

/// Shows a list of images, then ends or fails.
class ListSource : public Source {
 public:
  explicit ListSource(std::vector<CapturedImage> images, std::string error = "")
      : images_(std::move(images)), error_(std::move(error)) {}
  Result<std::optional<CapturedImage>> Next() override {
    if (next_ < images_.size()) return std::optional(images_[next_++]);
    if (!error_.empty()) return Error{error_};
    return std::optional<CapturedImage>();
  }

 private:
  std::vector<CapturedImage> images_;
  std::string error_;
  size_t next_ = 0;
};

class CaptureServiceTest : public ::testing::Test {
 protected:
  void SetUp() override {
    bus_ = *Bus::Open("memq://");
    loop_.AddFd(bus_->fd(), [this] { bus_->HandleReadable(); });
    bus_->Subscribe<msg::Frame>([this](msg::Frame frame) {
      frames_.push_back(std::move(frame));
      if (frames_.size() == wanted_) loop_.Stop();
    });
    bus_->Subscribe<msg::Status>(
        [this](msg::Status status) { statuses_.push_back(std::move(status)); });
    loop_.After(20 * kSecond, [this] { loop_.Stop(); });
  }

  RunLoop loop_;
  std::unique_ptr<Bus> bus_;
  ManualClock clock_{1'000'000};
  std::vector<msg::Frame> frames_;
  std::vector<msg::Status> statuses_;
  size_t wanted_ = 0;
};

TEST_F(CaptureServiceTest, RepeatsAStillImageWithFreshTimes) {
  Service service(std::make_unique<StillSource>(Image("table.pcd", 0.8f)), 60, *bus_, loop_,
                  clock_);
  for (int i = 0; i < 3; ++i) {
    service.PublishNext();
    clock_.Advance(500'000);
  }
  wanted_ = 3;
  loop_.Run();
  ASSERT_GE(frames_.size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(frames_[i].seq, static_cast<int64_t>(i + 1));
    EXPECT_EQ(frames_[i].utime, 1'000'000 + static_cast<Utime>(i) * 500'000);
    EXPECT_EQ(frames_[i].source, "table.pcd");
    EXPECT_EQ(frames_[i].depth, frames_[0].depth);
    EXPECT_EQ(frames_[i].colour, frames_[0].colour);
  }
  const auto image = DecodeImage(frames_[0]);
  ASSERT_TRUE(image.ok()) << image.error().message;
  EXPECT_EQ(image->width, 64);
  EXPECT_EQ(image->intrinsics.fy, 61);
  EXPECT_NEAR(image->depth_m[100], 0.8, 1e-6);
  EXPECT_EQ(image->depth_m[5], 0);
}

TEST_F(CaptureServiceTest, TimerPublishesAndStatusTells) {
  Service service(std::make_unique<StillSource>(Image("table.pcd", 0.8f)), 20, *bus_, loop_,
                  clock_);
  wanted_ = 25;
  loop_.Run();
  EXPECT_GE(frames_.size(), 25u);
  ASSERT_FALSE(statuses_.empty());
  EXPECT_EQ(statuses_[0].service, "capture");
  EXPECT_EQ(statuses_[0].state, "showing table.pcd");
  int64_t images = 0;
  for (const auto& counter : statuses_[0].counters) {
    if (counter.name == "images") images = counter.value;
  }
  EXPECT_EQ(images, 1) << "a still image is compressed once";
}

TEST_F(CaptureServiceTest, StopsAtTheEndOfItsSource) {
  Service service(std::make_unique<ListSource>(std::vector{Image("a", 1), Image("b", 2)}), 60,
                  *bus_, loop_, clock_);
  loop_.Run();
  EXPECT_TRUE(service.status().ok());
  EXPECT_EQ(service.published(), 2);
}

TEST_F(CaptureServiceTest, TellsWhySourceFailed) {
  Service service(std::make_unique<ListSource>(std::vector{Image("a", 1)}, "unplugged"), 60, *bus_,
                  loop_, clock_);
  loop_.Run();
  ASSERT_FALSE(service.status().ok());
  EXPECT_EQ(service.status().error().message, "unplugged");
}

}  // namespace
}  // namespace beckon::capture
