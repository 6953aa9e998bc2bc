// Shape measured in the frame of the table: metric sizes, radius over height, roundness of slices,
// directions of normals, hollowness, handles and the outline. Beyond the dissertation's three cues.
#pragma once

#include "services/perception/cue_interface.h"

namespace beckon::perception {

class ShapeStatisticsCue : public Cue {
 public:
  std::string name() const override { return "shape"; }
  Encoding encoding() const override { return Encoding::kStatistics; }
  int dimension() const override;
  Descriptors Describe(const CueView& view) const override;
};

}  // namespace beckon::perception
