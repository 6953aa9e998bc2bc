#include "services/capture/service.h"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "lcmtypes/frame_image.h"

namespace beckon::capture {
namespace {

constexpr double kDepthUnit_m = 1e-4;
constexpr int kJpegQuality = 92;

}  // namespace

Service::Service(std::unique_ptr<Source> source, double rate_hz, Bus& bus, RunLoop& loop,
                 const Clock& clock)
    : source_(std::move(source)),
      rate_hz_(rate_hz),
      bus_(bus),
      loop_(loop),
      clock_(clock),
      timer_(loop.Every(std::max<Utime>(1, static_cast<Utime>(kSecond / rate_hz)),
                        [this] { PublishNext(); })),
      reporter_("capture", bus, loop, [this](msg::Status& status) { FillStatus(status); }) {}

Service::~Service() { loop_.Cancel(timer_); }

Status Service::Encode(const CapturedImage& captured) {
  if (captured.image == encoded_) return {};
  msg::Frame frame;
  if (auto status = EncodeImage(*captured.image, kDepthUnit_m, kJpegQuality, frame); !status) {
    return Error{captured.name + ": " + status.error().message};
  }
  frame.source = captured.name;
  frame_ = std::move(frame);
  encoded_ = captured.image;
  ++encoded_images_;
  return {};
}

void Service::PublishNext() {
  auto next = source_->Next();
  if (!next || !next->has_value()) {
    if (!next) status_ = next.error();
    loop_.Cancel(timer_);
    return loop_.Stop();
  }
  Status done = Encode(**next);
  if (done) {
    frame_.utime = clock_.Now();
    frame_.seq = published_ + 1;
    done = bus_.Publish(frame_);
  }
  if (done) {
    ++published_;
    return;
  }
  if (failed_++ == 0) spdlog::warn("frame not published: {}", done.error().message);
}

void Service::FillStatus(msg::Status& status) const {
  status.state = frame_.source.empty() ? "waiting for the first image" : "showing " + frame_.source;
  status.counters.push_back({"frames", published_});
  status.counters.push_back({"images", encoded_images_});
  status.counters.push_back({"failed", failed_});
  status.counters.push_back(
      {"frame_bytes", static_cast<int64_t>(frame_.depth.size() + frame_.colour.size())});
}

}  // namespace beckon::capture
