#include "services/ui_bridge/bci/calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "services/ui_bridge/bci/simulated_decoding.h"

namespace beckon::ui_bridge::bci {
namespace {

constexpr double kPriorVariance = 0.3 * 0.3;
constexpr int kSweeps = 25;
constexpr double kMostExponent = 5;
constexpr double kLeastGap = 0.1;

/// The two features of a trial's classes: log p and log of what the confusion makes of p.
struct Features {
  size_t meant;
  double weight;
  std::vector<std::array<double, 2>> of_class;
};

/// First and second derivative of the log posterior by one exponent.
struct Slope {
  double first = 0, second = 0;
};

Slope SlopeOf(const std::vector<Features>& trials, const std::array<double, 2>& exponents,
              size_t which) {
  Slope slope;
  std::vector<double> p;
  for (const Features& trial : trials) {
    p.clear();
    double most = -1e300;
    for (const auto& f : trial.of_class) {
      p.push_back(exponents[0] * f[0] + exponents[1] * f[1]);
      most = std::max(most, p.back());
    }
    double sum = 0, mean = 0, square = 0;
    for (double& one : p) sum += one = std::exp(one - most);
    for (size_t i = 0; i < p.size(); ++i) {
      const double f = trial.of_class[i][which];
      mean += p[i] / sum * f;
      square += p[i] / sum * f * f;
    }
    slope.first += trial.weight * (trial.of_class[trial.meant][which] - mean);
    slope.second -= trial.weight * std::max(0.0, square - mean * mean);
  }
  return slope;
}

}  // namespace

Calibration::Calibration(size_t classes, const CalibrationConfig& config)
    : classes_(classes), config_(config) {}

bool Calibration::Add(KnownTrial trial) {
  if (trial.meant >= classes_ || !CheckProbabilities(trial.probabilities, classes_)) return false;
  trials_.push_back(std::move(trial));
  if (trials_.size() > static_cast<size_t>(config_.most_trials)) trials_.pop_front();
  return true;
}

Confusion Calibration::ExpectedConfusion() const {
  Confusion counts = EvenConfusion(classes_, config_.prior_accuracy);
  const double each = config_.prior_trials / static_cast<double>(classes_);
  for (auto& row : counts)
    for (double& count : row) count *= each;
  double weight = 1;
  for (auto trial = trials_.rbegin(); trial != trials_.rend(); ++trial, weight *= config_.fading)
    for (size_t j = 0; j < classes_; ++j)
      counts[trial->meant][j] += weight * trial->probabilities[j];
  for (auto& row : counts) {
    double sum = 0;
    for (const double count : row) sum += count;
    for (double& count : row) count /= sum;
  }
  return counts;
}

double Calibration::Accuracy() const {
  double right = config_.prior_accuracy * config_.prior_trials, all = config_.prior_trials;
  double weight = 1;
  for (auto trial = trials_.rbegin(); trial != trials_.rend(); ++trial, weight *= config_.fading) {
    const auto& p = trial->probabilities;
    const auto best = std::max_element(p.begin(), p.end()) - p.begin();
    right += static_cast<size_t>(best) == trial->meant ? weight : 0;
    all += weight;
  }
  return right / all;
}

double Calibration::Gap(const DecoderModel& model) const {
  const double least = 1.05 / static_cast<double>(classes_);
  const double d =
      SimulatedDecoding(classes_, std::max(config_.prior_accuracy, least)).separation();
  double sum = config_.prior_trials * config_.prior_sharpness * d * d, all = config_.prior_trials;
  double weight = 1;
  for (auto trial = trials_.rbegin(); trial != trials_.rend(); ++trial, weight *= config_.fading) {
    const auto logs = LogLikelihoods(trial->probabilities, model);
    double others = -logs[trial->meant];
    for (const double log : logs) others += log;
    sum += weight * (logs[trial->meant] - others / static_cast<double>(classes_ - 1));
    all += weight;
  }
  return std::max(kLeastGap, sum / all);
}

DecoderModel Calibration::Fit() const {
  DecoderModel model{config_.prior_sharpness, 0, ExpectedConfusion(), 0};
  std::vector<double> rows(classes_, config_.prior_trials / static_cast<double>(classes_));
  std::vector<Features> trials;
  double weight = 1;
  for (auto trial = trials_.rbegin(); trial != trials_.rend(); ++trial, weight *= config_.fading) {
    rows[trial->meant] += weight;
    trials.push_back({trial->meant, weight, {}});
  }
  for (size_t t = 0; t < trials.size(); ++t) {
    const auto& probabilities = trials_[trials_.size() - 1 - t].probabilities;
    const std::vector<double> p = Softened(probabilities);
    for (size_t m = 0; m < classes_; ++m) {
      // Of the row that this trial is in, what the others say.
      const double own = m == trials[t].meant ? trials[t].weight : 0;
      double sum = 0;
      for (size_t j = 0; j < classes_; ++j) {
        const double count = model.confusion[m][j] * rows[m] - own * probabilities[j];
        sum += std::max(0.0, count) / (rows[m] - own) * p[j];
      }
      trials[t].of_class.push_back({std::log(p[m]), std::log(std::max(sum, 1e-12))});
    }
  }
  const std::array<double, 2> prior = {config_.prior_sharpness, 0};
  std::array<double, 2> exponents = prior;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (size_t which : {size_t{0}, size_t{1}}) {
      Slope slope = SlopeOf(trials, exponents, which);
      slope.first -= (exponents[which] - prior[which]) / kPriorVariance;
      slope.second -= 1 / kPriorVariance;
      const double step = std::clamp(-slope.first / slope.second, -0.5, 0.5);
      exponents[which] = std::clamp(exponents[which] + step, 0.0, kMostExponent);
    }
  }
  model.sharpness = exponents[0];
  model.habit = exponents[1];
  model.gap = Gap(model);
  return model;
}

}  // namespace beckon::ui_bridge::bci
