// What beckon-train learns and the categoriser uses.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/base/result.h"
#include "services/perception/svm_classifier.h"

namespace beckon::perception {

/// The category of views that show none of the others; a category like them in all machines.
inline constexpr char kUnknown[] = "Unknown";

inline constexpr uint32_t kMostCategories = 64;

/// What was learnt for one cue.
struct CueModel {
  std::string name;  // of the cue
  CueEncoder encoder;
  SvmClassifier classifier;
};

/// How some cues come to one answer.
struct Decider {
  std::vector<uint32_t> cues;  // indices into Model::cues, increasing
  SvmClassifier svm;  // over the square roots of these cues' probabilities, cue by cue; without
                      // classes where there is but one cue, which then decides alone
  std::vector<float> weights;  // of the cues' geometric mean that its answer is blended with, one a
                               // cue, >= 0, not all 0; empty: its answer as it comes
  SvmClassifier correction;    // what views that were added later say against it: log-odds to add,
                               // over the same features; without classes where there are none
  float temperature = 1;       // calibrates: p ~ p^(1 / temperature)
  float threshold = 0.5F;      // at or below this confidence the user is asked
};

struct Model {
  std::vector<std::string> categories;  // alphabetical, 2 .. kMostCategories
  std::vector<CueModel> cues;
  std::vector<Decider> deciders;  // first the one over all cues
  float unknown_prior = 1;        // factor on the probability of kUnknown: how much more frequent
                                  // strange things are than in training
  uint64_t seed = 0;              // of the training
  std::string description;        // of the training data, for people
};

/// Refuses a model whose parts do not fit each other or this program's cues.
Status Validate(const Model& model);

/// The decider of exactly these cues, null where there is none.
const Decider* FindDecider(const Model& model, const std::vector<uint32_t>& cues);

/// The calibrated probabilities from each of the decider's cues' (empty where a cue saw nothing);
/// empty where none saw anything.
std::vector<float> Decide(const Decider& decider, std::vector<std::vector<float>> by_cue);

/// What the decider's correction is added to: no category is ruled out for good.
std::vector<float> CorrectionOffsets(const std::vector<float>& decided);

/// Makes room for a category that the model does not know yet: no machine ever claims it, so that
/// only corrections can. It is in place where it is known.
void AddCategory(const std::string& category, Model& model);

/// Puts the geometric mean of the others in the place of what is empty; false where all are.
/// `weights`: of each, or empty for equal ones.
bool FillMissing(const std::vector<float>& weights, std::vector<std::vector<float>>& by_cue);

/// The cues' weighted geometric mean; no cue rules a category out on its own.
std::vector<float> MeanOfCues(const std::vector<float>& weights,
                              const std::vector<std::vector<float>>& by_cue);

/// A weighted geometric mean of what the decider says and what the cues say together. The decider
/// is right more often where the world is as in training; the mean suffers less where one cue meets
/// what it never saw.
std::vector<float> Blend(const std::vector<float>& decided, const std::vector<float>& weights,
                         const std::vector<std::vector<float>>& by_cue);

/// The decider's features.
Features StackFeatures(const std::vector<std::vector<float>>& by_cue);

/// p^(1 / temperature), scaled to sum 1.
std::vector<float> ApplyTemperature(const std::vector<float>& probabilities, float temperature);

/// The probability of kUnknown times `prior`, scaled to sum 1; as it is without kUnknown.
void ApplyUnknownPrior(const std::vector<std::string>& categories, float prior,
                       std::vector<float>& probabilities);

}  // namespace beckon::perception
