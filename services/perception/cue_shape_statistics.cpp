// The shape cue: all groups of measurements in a row.
#include "services/perception/cue_shape_statistics.h"

#include <cassert>
#include <cmath>

#include "services/perception/cue_shape_measures.h"

namespace beckon::perception {
namespace {
constexpr int kMeasures = 179;
}

int ShapeStatisticsCue::dimension() const { return kMeasures; }

Descriptors ShapeStatisticsCue::Describe(const CueView& view) const {
  std::vector<float> values;
  values.reserve(kMeasures);
  const Revolution body = FitRevolution(view);
  MeasureSizes(view, values);
  MeasureProfile(view, body, values);
  MeasureNormals(view, body, values);
  MeasureHollowness(view, body, values);
  MeasureOutline(view, values);
  assert(values.size() == kMeasures);
  values.resize(kMeasures);
  Descriptors out = Eigen::Map<Eigen::RowVectorXf>(values.data(), static_cast<int>(values.size()));
  // A measure that a strange view leaves undefined counts as zero.
  return out.unaryExpr([](float v) { return std::isfinite(v) ? v : 0.0F; });
}

}  // namespace beckon::perception
