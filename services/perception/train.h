// Learning a model from views whose categories are known. Pure: views in, model and diagnostics
// out.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "services/perception/model.h"

namespace beckon::perception {

struct TrainConfig {
  uint64_t seed = 1;
  int folds = 5;         // of the cross-validation; an instance's views share a fold
  int sift_words = 150;  // sizes of the vocabularies
  int hog_words = 150;
  int fpfh_words = 80;
  int vocabulary_views = 400;     // views, drawn at random, that vocabularies are learnt from
  int descriptors_per_view = 60;  // of them, at most, in a vocabulary's samples
  int kmeans_iterations = 12;
  double cost = 4;          // C of the cues' machines
  double gamma_scale = 1;   // their gamma times the median squared distance
  double decider_cost = 2;  // of the second stage
  double decider_gamma_scale = 0.5;
  double caution = 1.5;  // factor on the fitted temperature: the world is harder than a rendering
  double target_accuracy = 0.98;  // of what is answered without asking; decides the threshold
};

/// What cross-validation said of one view.
struct HeldOutPrediction {
  int label = 0;                     // index into Model::categories
  std::vector<float> probabilities;  // calibrated
  float confidence = 0;
  std::vector<std::vector<float>> by_cue;
};

struct TrainOutcome {
  Model model;
  std::vector<HeldOutPrediction> held_out;  // in the order of Add
};

/// Takes the views twice, one at a time, so that they need not fit into memory together: first
/// those it learns vocabularies from, then all.
class Trainer {
 public:
  explicit Trainer(const TrainConfig& config);
  ~Trainer();

  /// Indices of the views, of `count`, that SampleView wants to see.
  std::vector<size_t> ChooseSamples(size_t count);
  /// Views with fewer than Categoriser::kMinPoints points are refused.
  Status SampleView(const ObjectView& view);
  /// Call between the last SampleView and the first Add.
  void LearnEncoders();
  Status Add(const ObjectView& view, const std::string& category, const std::string& instance);
  /// `progress` is told what is being done. Fails where there are fewer than two categories, or
  /// fewer than two instances of one: nothing could be held out.
  Result<TrainOutcome> Finish(const std::function<void(const std::string&)>& progress);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The fold of each instance: instances of a category are dealt out evenly, in random order.
std::map<std::string, int> DealFolds(const std::map<std::string, std::string>& category_of_instance,
                                     int folds, uint64_t seed);

/// The temperature under which `probabilities` are likeliest.
float FitTemperature(const std::vector<std::vector<float>>& probabilities,
                     const std::vector<int>& labels);

}  // namespace beckon::perception
