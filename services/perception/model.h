// What beckon-train learns and the categoriser uses.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/base/result.h"
#include "services/perception/svm_classifier.h"

namespace beckon::perception {

/// What was learnt for one cue.
struct CueModel {
  std::string name;  // of the cue
  CueEncoder encoder;
  SvmClassifier classifier;
};

struct Model {
  std::vector<std::string> categories;  // alphabetical, two at least
  std::vector<CueModel> cues;
  SvmClassifier decider;    // over the square roots of all cues' probabilities, cue by cue
  float temperature = 1;    // calibrates: p ~ p^(1 / temperature)
  float threshold = 0.5F;   // at or below this confidence the user is asked
  uint64_t seed = 0;        // of the training
  std::string description;  // of the training data, for people
};

/// Refuses a model whose parts do not fit each other or this program's cues.
Status Validate(const Model& model);

/// The blended, calibrated probabilities from each cue's.
std::vector<float> Decide(const Model& model, const std::vector<std::vector<float>>& by_cue);

/// A weighted geometric mean of what the decider says and what the cues say together (their
/// geometric mean). The decider is right more often where the world is as in training; the mean
/// suffers less where one cue meets what it never saw.
std::vector<float> Blend(const std::vector<float>& decided,
                         const std::vector<std::vector<float>>& by_cue);

/// The decider's features.
Features StackFeatures(const std::vector<std::vector<float>>& by_cue);

/// p^(1 / temperature), scaled to sum 1.
std::vector<float> ApplyTemperature(const std::vector<float>& probabilities, float temperature);

}  // namespace beckon::perception
