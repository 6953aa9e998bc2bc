// The second stage: a machine over the cues' probabilities, its calibration and its threshold.
#include <algorithm>

#include "services/perception/categoriser_confidence.h"
#include "services/perception/train.h"
#include "services/perception/train_report.h"

namespace beckon::perception {
namespace {

using ByCue = std::vector<std::vector<float>>;

/// What the decider says before calibration, of views that it and its cues were not trained on.
std::optional<std::vector<std::vector<float>>> HeldOutDecisions(const TrainConfig& config,
                                                                const std::vector<ByCue>& inputs,
                                                                SvmTrainingSet set,
                                                                const StepProgress& done,
                                                                Decider& decider) {
  std::vector<std::vector<float>> decisions;
  if (decider.cues.size() == 1) {
    for (const ByCue& input : inputs) decisions.push_back(input.front());
    return decisions;
  }
  set.features.clear();
  for (const ByCue& input : inputs) set.features.push_back(StackFeatures(input));
  auto trained =
      TrainSvm(set, {config.decider_cost, config.decider_gamma_scale, config.threads}, done);
  if (!trained) return std::nullopt;
  decider.svm = std::move(trained->classifier);
  for (size_t i = 0; i < inputs.size(); ++i) {
    decisions.push_back(decider.weights.empty()
                            ? std::move(trained->out_of_fold[i])
                            : Blend(trained->out_of_fold[i], decider.weights, inputs[i]));
  }
  return decisions;
}

}  // namespace

std::optional<TrainedDecider> TrainDecider(const TrainConfig& config,
                                           const std::vector<std::string>& categories,
                                           std::vector<uint32_t> cues, std::vector<float> weights,
                                           const std::vector<ByCue>& by_cue,
                                           const SvmTrainingSet& all, const StepProgress& done) {
  TrainedDecider out;
  out.decider.cues = std::move(cues);
  out.decider.weights = std::move(weights);
  SvmTrainingSet set;  // of the views that any of the cues sees
  set.classes = all.classes;
  set.fold_count = all.fold_count;
  std::vector<ByCue> inputs;
  std::vector<size_t> views;
  out.held_out.resize(by_cue.size());
  for (size_t i = 0; i < by_cue.size(); ++i) {
    out.held_out[i].label = all.labels[i];
    ByCue input;
    for (const uint32_t c : out.decider.cues) input.push_back(by_cue[i][c]);
    if (!FillMissing(out.decider.weights, input)) continue;
    inputs.push_back(std::move(input));
    views.push_back(i);
    set.labels.push_back(all.labels[i]);
    set.folds.push_back(all.folds[i]);
  }
  const auto decisions = HeldOutDecisions(config, inputs, set, done, out.decider);
  if (!decisions) return std::nullopt;
  out.decider.temperature =
      static_cast<float>(config.caution) * FitTemperature(*decisions, set.labels);
  for (size_t i = 0; i < views.size(); ++i) {
    HeldOutPrediction& held_out = out.held_out[views[i]];
    held_out.probabilities = ApplyTemperature((*decisions)[i], out.decider.temperature);
    ApplyUnknownPrior(categories, static_cast<float>(config.unknown_prior), held_out.probabilities);
    held_out.confidence = RenyiConfidence(held_out.probabilities);
  }
  out.decider.threshold = ChooseThreshold(Judge(out.held_out), config.target_accuracy);
  return out;
}

}  // namespace beckon::perception
