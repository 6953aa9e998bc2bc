// The capture service: takes images from a source and publishes them as FRAME.
#pragma once

#include <memory>

#include "lcmtypes/messages.h"
#include "services/base/bus.h"
#include "services/base/run_loop.h"
#include "services/base/status_reporter.h"
#include "services/base/utime.h"
#include "services/capture/source.h"

namespace beckon::capture {

/// While it lives, publishes the source's images at `rate_hz`, each with a fresh utime and the next
/// seq. An image that the source hands out again is not compressed again. At the source's end, or
/// where it fails for good, the loop is stopped and `status` tells why.
class Service {
 public:
  Service(std::unique_ptr<Source> source, double rate_hz, Bus& bus, RunLoop& loop,
          const Clock& clock);
  ~Service();
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// Publishes one image now; what the timer calls.
  void PublishNext();

  Status status() const { return status_; }
  int64_t published() const { return published_; }

 private:
  Status Encode(const CapturedImage& captured);
  void FillStatus(msg::Status& status) const;

  std::unique_ptr<Source> source_;
  double rate_hz_;
  Bus& bus_;
  RunLoop& loop_;
  const Clock& clock_;
  std::shared_ptr<const RgbdImage> encoded_;  // what frame_ holds
  msg::Frame frame_;
  int64_t published_ = 0;
  int64_t encoded_images_ = 0;
  int64_t failed_ = 0;
  Status status_;
  RunLoop::TimerId timer_;
  StatusReporter reporter_;
};

}  // namespace beckon::capture
