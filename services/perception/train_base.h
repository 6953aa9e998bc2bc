// Improving a model that is there by a few views of one's own, without what it was trained on.
#pragma once

#include <string>
#include <vector>

#include "services/perception/train.h"

namespace beckon::perception {

/// The machines stay as they are. Each decider over several cues gets a correction: kernel logistic
/// regression (Zhu and Hastie 2005) on the own views over the decider's features, with the model's
/// log-odds as its offset. It is a sum of bumps around own views, each as high as the model
/// errs there: far from them the model says what it said. Views of one object count together as
/// the square root of their number.
class BaseTrainer {
 public:
  /// Categories that `base` does not know are added to it.
  BaseTrainer(Model base, const std::vector<std::string>& categories);

  /// What each cue says of the view, for Add; may run in several threads. Views with fewer than
  /// Categoriser::kMinPoints points are refused.
  Result<std::vector<std::vector<float>>> Describe(const ObjectView& view) const;
  void Add(std::vector<std::vector<float>> by_cue, const std::string& category,
           const std::string& instance);

  /// The improved model; held_out is what it says of each own view where the view's object was not
  /// among those it was improved by. `before`: what the base says of them. Fails where a category
  /// has no view, or `watch` wants to stop.
  struct Outcome {
    TrainOutcome improved;
    std::vector<HeldOutPrediction> before;
  };
  Result<Outcome> Finish(const TrainConfig& config, const Watch& watch);

 private:
  Status CheckCategories() const;
  /// What the views say against the decider.
  SvmClassifier Correct(const Decider& decider, const std::vector<size_t>& views) const;
  HeldOutPrediction Predict(const Decider& decider, size_t view) const;
  std::vector<std::vector<float>> InputOf(const Decider& decider, size_t view) const;

  Model model_;
  std::vector<std::string> wanted_;
  std::vector<std::unique_ptr<const Cue>> cues_;
  std::vector<std::vector<std::vector<float>>> by_cue_;
  std::vector<int> labels_;
  std::vector<std::string> instances_;
};

}  // namespace beckon::perception
