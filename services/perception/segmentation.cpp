// The names of the segmentation methods, and the choice among them.
#include "services/perception/segmentation.h"

#include "services/perception/segmentation_fast.h"
#include "services/perception/segmentation_reference.h"

namespace beckon::perception {

const char* Name(SegmentationMethod method) {
  return method == SegmentationMethod::kReference ? "reference" : "fast";
}

Result<SegmentationMethod> ParseSegmentationMethod(const std::string& name) {
  for (const auto method : {SegmentationMethod::kFast, SegmentationMethod::kReference}) {
    if (name == Name(method)) return method;
  }
  return Error{"segmentation: there is no method '" + name +
               "' in this build; it has: fast, reference"};
}

Segmentation Segment(const RgbdImage& image, const SegmentationConfig& config,
                     const StepObserver& done) {
  return config.method == SegmentationMethod::kReference ? SegmentReference(image, config, done)
                                                         : SegmentFast(image, config, done);
}

}  // namespace beckon::perception
