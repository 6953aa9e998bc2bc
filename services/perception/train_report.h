// What a model's predictions are worth: accuracy, confusions, and what the threshold T buys.
#pragma once

#include <string>
#include <vector>

#include "services/perception/train.h"

namespace beckon::perception {

/// One view: what it is, what it was taken for, how surely.
struct Judgement {
  int label = 0;
  int predicted = 0;
  bool in_top_3 = false;
  float confidence = 0;
  float probability = 0;  // of `predicted`
};

/// Without the views that no cue saw.
std::vector<Judgement> Judge(const std::vector<HeldOutPrediction>& predictions);

double Accuracy(const std::vector<Judgement>& judgements);
double Top3Accuracy(const std::vector<Judgement>& judgements);
/// Mean over the categories that have views.
double MacroRecall(const std::vector<Judgement>& judgements, size_t categories);
/// Of the share of views with the highest confidence.
double SurestAccuracy(const std::vector<Judgement>& judgements, double share);

/// The smallest T for which the views with a confidence above it are right at `target_accuracy`;
/// where none is, one that asks about everything.
float ChooseThreshold(std::vector<Judgement> judgements, double target_accuracy);

/// Counts, one row a category, one column a prediction.
std::vector<std::vector<int>> Confusions(const std::vector<Judgement>& judgements,
                                         size_t categories);
std::string ConfusionTable(const std::vector<Judgement>& judgements,
                           const std::vector<std::string>& categories);
/// Accuracy of what is answered without asking over T; `chosen` is marked.
std::string RiskCoverageTable(const std::vector<Judgement>& judgements, float chosen);
/// What each of the model's deciders is worth held out: all cues, the dissertation's, each alone.
std::string CueTable(const TrainOutcome& outcome);
/// "all", "dissertation" or the names of a decider's cues.
std::string DeciderName(const Model& model, const Decider& decider);

/// The confusion matrix as a PNG.
Status DrawConfusions(const std::vector<Judgement>& judgements,
                      const std::vector<std::string>& categories, const std::string& path);
/// Accuracy of the surest share of the views over that share; `threshold` is marked.
Status DrawRiskCoverage(const std::vector<Judgement>& judgements, float threshold,
                        const std::string& path);
/// How often what is said with a probability is right, over that probability.
Status DrawReliability(const std::vector<Judgement>& judgements, const std::string& path);

}  // namespace beckon::perception
