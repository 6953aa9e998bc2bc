// The names of the segmentation methods, and the choice among them.
#include "services/perception/segmentation.h"

#include "services/perception/segmentation_reference.h"

namespace beckon::perception {

const char* Name(SegmentationMethod) { return "reference"; }

Result<SegmentationMethod> ParseSegmentationMethod(const std::string& name) {
  if (name == "reference") return SegmentationMethod::kReference;
  return Error{"segmentation: there is no method '" + name + "' in this build; it has: reference"};
}

Segmentation Segment(const RgbdImage& image, const SegmentationConfig& config,
                     const StepObserver& done) {
  return SegmentReference(image, config, done);
}

}  // namespace beckon::perception
