// Shape: fast point feature histograms (Rusu, Blodow and Beetz 2009), the dissertation's third cue.
#pragma once

#include "services/perception/cue_interface.h"

namespace beckon::perception {

class FpfhCue : public Cue {
 public:
  static constexpr int kBins = 11;  // for each of the three angles

  std::string name() const override { return "fpfh"; }
  Encoding encoding() const override { return Encoding::kBag; }
  int dimension() const override { return 3 * kBins; }
  /// One row a point of the view; each angle's histogram sums to 1 (0 for a point without
  /// neighbours).
  Descriptors Describe(const CueView& view) const override;
};

}  // namespace beckon::perception
