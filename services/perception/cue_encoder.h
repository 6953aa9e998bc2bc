// From a cue's descriptors to the bytes that its classifier takes.
#pragma once

#include <cstdint>
#include <vector>

#include "services/perception/cue_interface.h"

namespace beckon::perception {

/// A feature vector: 0..255 stands for 0..1. Classifiers are trained on the very bytes they meet
/// later.
using Features = std::vector<uint8_t>;

/// What is learnt of one cue's descriptors before any classifier.
struct CueEncoder {
  static constexpr int kQuantiles = 33;

  Descriptors vocabulary;  // kBag: words x dimension; else empty
  Descriptors
      quantiles;  // kStatistics: kQuantiles x dimension, increasing down each column; else empty

  /// Length of the features of a cue.
  int FeatureCount(const Cue& cue) const;
  Features Encode(const Cue& cue, const Descriptors& descriptors) const;
};

/// Quantile tables from one row of measurements a view.
Descriptors LearnQuantiles(const Descriptors& measurements);

/// Bytes from numbers in 0..1.
Features ToFeatures(const Eigen::Ref<const Eigen::RowVectorXf>& values);

}  // namespace beckon::perception
