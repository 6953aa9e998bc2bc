// Words, quantiles and bytes.
#include "services/perception/cue_encoder.h"

#include <algorithm>

#include "services/perception/bag_of_words.h"

namespace beckon::perception {
namespace {

/// Where `value` lies in an increasing table, 0..1; the middle of a run of equal entries.
float Rank(const Descriptors& quantiles, int column, float value) {
  const int n = static_cast<int>(quantiles.rows());
  int below = 0, not_above = 0;
  while (below < n && quantiles(below, column) < value) ++below;
  not_above = below;
  while (not_above < n && quantiles(not_above, column) <= value) ++not_above;
  const float scale = 1.0F / static_cast<float>(n - 1);
  if (not_above > below) return 0.5F * static_cast<float>(below + not_above - 1) * scale;
  if (below == 0) return 0;
  if (below == n) return 1;
  const float low = quantiles(below - 1, column), high = quantiles(below, column);
  return (static_cast<float>(below - 1) + (value - low) / (high - low)) * scale;
}

}  // namespace

int CueEncoder::FeatureCount(const Cue& cue) const {
  return cue.encoding() == Encoding::kBag ? static_cast<int>(vocabulary.rows()) : cue.dimension();
}

Features CueEncoder::Encode(const Cue& cue, const Descriptors& descriptors) const {
  switch (cue.encoding()) {
    case Encoding::kBag:
      return ToFeatures(BagOfWords(vocabulary, descriptors));
    case Encoding::kStatistics: {
      Eigen::RowVectorXf ranks(descriptors.cols());
      for (int i = 0; i < ranks.size(); ++i) ranks[i] = Rank(quantiles, i, descriptors(0, i));
      return ToFeatures(ranks);
    }
    case Encoding::kDense:
      break;
  }
  return ToFeatures(descriptors.row(0));
}

Descriptors LearnQuantiles(const Descriptors& measurements) {
  Descriptors table(CueEncoder::kQuantiles, measurements.cols());
  for (int column = 0; column < measurements.cols(); ++column) {
    std::vector<float> values(static_cast<size_t>(measurements.rows()));
    for (int row = 0; row < measurements.rows(); ++row) {
      values[static_cast<size_t>(row)] = measurements(row, column);
    }
    std::sort(values.begin(), values.end());
    for (int q = 0; q < CueEncoder::kQuantiles; ++q) {
      const size_t at = static_cast<size_t>(q) * (values.size() - 1) / (CueEncoder::kQuantiles - 1);
      table(q, column) = values[at];
    }
  }
  return table;
}

Features ToFeatures(const Eigen::Ref<const Eigen::RowVectorXf>& values) {
  Features out(static_cast<size_t>(values.size()));
  for (int i = 0; i < values.size(); ++i) {
    out[static_cast<size_t>(i)] =
        static_cast<uint8_t>(std::clamp(values[i], 0.0F, 1.0F) * 255 + 0.5F);
  }
  return out;
}

}  // namespace beckon::perception
