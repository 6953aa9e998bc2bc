// Appearance: SIFT keypoints of the object's crop (Lowe 2004), as the dissertation's first cue.
#pragma once

#include "services/perception/cue_interface.h"

namespace beckon::perception {

class SiftCue : public Cue {
 public:
  std::string name() const override { return "sift"; }
  Encoding encoding() const override { return Encoding::kBag; }
  int dimension() const override { return 128; }
  float weight() const override { return 0.1F; }  // rendered pictures are no real ones
  Descriptors Describe(const CueView& view) const override;
};

}  // namespace beckon::perception
