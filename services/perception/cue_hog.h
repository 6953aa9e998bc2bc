// Contour: histograms of oriented gradients (Dalal and Triggs 2005) of the object's crop.
#pragma once

#include "services/perception/cue_interface.h"

namespace beckon::perception {

/// The dissertation's second cue: a bag of HOG blocks of outline and brightness. Each block carries
/// its place in the crop.
class HogCue : public Cue {
 public:
  std::string name() const override { return "hog"; }
  Encoding encoding() const override { return Encoding::kBag; }
  int dimension() const override { return 2 * 36 + 2; }
  float weight() const override { return 0.3F; }
  Descriptors Describe(const CueView& view) const override;
};

/// One HOG over the whole crop of the depth, and one over the outline.
class DepthHogCue : public Cue {
 public:
  std::string name() const override { return "depth_hog"; }
  Encoding encoding() const override { return Encoding::kDense; }
  int dimension() const override { return 2 * 6 * 6 * 9; }
  float weight() const override { return 0.5F; }
  Descriptors Describe(const CueView& view) const override;
};

}  // namespace beckon::perception
