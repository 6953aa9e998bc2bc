// The cue of the object's own frame: both groups of measurements in a row.
#include "services/perception/cue_own_frame.h"

#include <cassert>
#include <cmath>

namespace beckon::perception {
namespace {
constexpr int kMeasures = 37 + 24;
}

int OwnFrameCue::dimension() const { return kMeasures; }

Descriptors OwnFrameCue::Describe(const CueView& view) const {
  std::vector<float> values;
  values.reserve(kMeasures);
  MeasureOwnAxis(view, values);
  MeasureFaces(view, values);
  assert(values.size() == kMeasures);
  values.resize(kMeasures);
  const Descriptors out =
      Eigen::Map<Eigen::RowVectorXf>(values.data(), static_cast<int>(values.size()));
  return out.unaryExpr([](float v) { return std::isfinite(v) ? v : 0.0F; });
}

}  // namespace beckon::perception
