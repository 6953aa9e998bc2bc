// Training of one-against-all RBF machines with libsvm, with out-of-fold decisions for everything
// that is learnt on top of them.
#pragma once

#include <optional>
#include <vector>

#include "services/perception/svm_classifier.h"
#include "services/perception/train_parallel.h"

namespace beckon::perception {

struct SvmTrainingConfig {
  double cost = 10;        // C of the soft margin
  double gamma_scale = 1;  // gamma = this / median squared distance between training vectors
  int threads = 1;         // machines trained at a time; the result does not depend on it
};

/// Features with their class (0 .. classes - 1) and fold (0 .. folds - 1).
struct SvmTrainingSet {
  std::vector<Features> features;
  std::vector<int> labels;
  std::vector<int> folds;
  int classes = 0;
  int fold_count = 0;
};

struct TrainedSvm {
  SvmClassifier classifier;                     // trained on everything, prepared
  std::vector<std::vector<float>> out_of_fold;  // probabilities of each sample by machines that
                                                // never saw its fold
};

/// Every class needs a sample in at least two folds. Same input, same machine. Nothing where
/// `done`, which is told how many machines are trained of how many, wants to stop.
std::optional<TrainedSvm> TrainSvm(const SvmTrainingSet& set, const SvmTrainingConfig& config,
                                   const StepProgress& done = {});

/// Fits Platt's sigmoid by Newton's method (Lin, Lin and Weng 2007).
Sigmoid FitSigmoid(const std::vector<double>& decisions, const std::vector<bool>& positive);

}  // namespace beckon::perception
