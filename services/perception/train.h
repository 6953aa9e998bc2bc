// Learning a model from views whose categories are known. Pure: views in, model and diagnostics
// out.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/perception/model.h"
#include "services/perception/object_view.h"
#include "services/perception/train_svm.h"

namespace beckon::perception {

struct TrainConfig {
  uint64_t seed = 1;
  std::string cues = "all";  // that the model holds, as ParseCueNames takes them
  int folds = 5;             // of the cross-validation; an instance's views share a fold
  int sift_words = 150;      // sizes of the vocabularies
  int hog_words = 150;
  int fpfh_words = 80;
  int vocabulary_views = 400;     // views, drawn at random, that vocabularies are learnt from
  int descriptors_per_view = 60;  // of them, at most, in a vocabulary's samples
  int kmeans_iterations = 12;
  double cost = 4;          // C of the cues' machines
  double gamma_scale = 1;   // their gamma times the median squared distance
  double decider_cost = 2;  // of the second stage
  double decider_gamma_scale = 0.5;
  double unknown_prior = 0.2;  // Model::unknown_prior: a training set holds more strange things
                               // than a table does
  int threads = 1;  // nothing depends on it but the time
  double caution =
      1;  // factor on the fitted temperature; above 1: less sure than held-out views say
  double target_accuracy = 0.96;  // of what is answered without asking; decides the threshold
};

/// What cross-validation said of one view.
struct HeldOutPrediction {
  int label = 0;                     // index into Model::categories
  std::vector<float> probabilities;  // calibrated; empty where no cue saw anything
  float confidence = 0;
};

struct TrainOutcome {
  Model model;
  std::vector<std::vector<HeldOutPrediction>> held_out;  // by decider, in the order of Add
  std::vector<std::string> notes;  // what a person should know: cues left out, and why
};

/// Told what is being done and how much of it; false: stop.
using Watch = std::function<bool(const std::string& step, size_t done, size_t total)>;

/// What the vocabularies are learnt from, of one view: descriptors by cue.
using ViewSample = std::vector<Descriptors>;
/// What the machines are trained with, of one view: by cue, nothing where the cue cannot see it.
using ViewFeatures = std::vector<std::optional<Features>>;

/// Takes the views twice, one at a time, so that they need not fit into memory together: first
/// those it learns vocabularies from, then all. Sample and Describe may run in several threads;
/// what they gave is added in an order of the caller's, which decides the model.
class Trainer {
 public:
  /// Fails where the configuration names a cue that is not there.
  static Result<Trainer> Make(const TrainConfig& config);
  ~Trainer();
  Trainer(Trainer&&) noexcept;

  /// Indices of the views, of `count`, that Sample wants to see.
  std::vector<size_t> ChooseSamples(size_t count);
  /// Views with fewer than Categoriser::kMinPoints points are refused.
  Result<ViewSample> Sample(const ObjectView& view) const;
  void Add(ViewSample sample);
  /// Call between the last Sample and the first Describe.
  void LearnEncoders();
  /// The same of the view's features.
  Result<ViewFeatures> Describe(const ObjectView& view) const;
  void Add(ViewFeatures features, const std::string& category, const std::string& instance);
  /// Fails where there are fewer than two categories, or fewer than two instances of one: nothing
  /// could be held out; and where `watch` (may be empty) wants to stop.
  Result<TrainOutcome> Finish(const Watch& watch);

 private:
  struct State;
  explicit Trainer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// The decider of these cues of the model, with what it said of each view held out. `by_cue`: of
/// each view, of each of all the model's cues; `set`: labels and folds of the views.
struct TrainedDecider {
  Decider decider;
  std::vector<HeldOutPrediction> held_out;
};
std::optional<TrainedDecider> TrainDecider(
    const TrainConfig& config, const std::vector<std::string>& categories,
    std::vector<uint32_t> cues, std::vector<float> weights,
    const std::vector<std::vector<std::vector<float>>>& by_cue, const SvmTrainingSet& set,
    const StepProgress& done);

/// The fold of each instance: instances of a category are dealt out evenly, in random order.
std::map<std::string, int> DealFolds(const std::map<std::string, std::string>& category_of_instance,
                                     int folds, uint64_t seed);

/// The temperature under which `probabilities` are likeliest.
float FitTemperature(const std::vector<std::vector<float>>& probabilities,
                     const std::vector<int>& labels);

}  // namespace beckon::perception
