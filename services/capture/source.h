// Where images come from.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "services/base/rgbd.h"

namespace beckon::capture {

/// An image and its name, e.g. "table.pcd" or "embedded:1". Shared, so that a still image that is
/// handed out again and again is known to be the same and is compressed only once.
struct CapturedImage {
  std::shared_ptr<const RgbdImage> image;
  std::string name;
};

class Source {
 public:
  virtual ~Source() = default;
  /// The next image; nothing at the end. A still image never ends.
  virtual Result<std::optional<CapturedImage>> Next() = 0;
};

/// One image, for ever.
class StillSource : public Source {
 public:
  explicit StillSource(CapturedImage image) : image_(std::move(image)) {}
  Result<std::optional<CapturedImage>> Next() override { return std::optional(image_); }

 private:
  CapturedImage image_;
};

}  // namespace beckon::capture
