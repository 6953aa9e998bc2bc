// Shape measured in the object's own frame, so that it counts the same whether an object stands,
// lies or leans: the body of revolution about its own axis, and the flat faces it has. Beyond the
// dissertation's three cues.
#pragma once

#include <vector>

#include "services/perception/cue_interface.h"

namespace beckon::perception {

class OwnFrameCue : public Cue {
 public:
  std::string name() const override { return "own_frame"; }
  Encoding encoding() const override { return Encoding::kStatistics; }
  int dimension() const override;
  Descriptors Describe(const CueView& view) const override;
};

/// Radius over the length of the axis about which the surface turns best, its ends, how well it
/// turns.
void MeasureOwnAxis(const CueView& view, std::vector<float>& out);
/// The three largest directions that the surface faces: their shares, sizes and angles.
void MeasureFaces(const CueView& view, std::vector<float>& out);

}  // namespace beckon::perception
