#include "services/intention/core/error_model.h"

#include <algorithm>
#include <cmath>

namespace beckon::intention {
namespace {

constexpr double kWorstRate = 0.45;

double Term(double count, double probability) {
  if (count == 0) return 0;
  return count * std::log(std::max(probability, 1e-300));
}

}  // namespace

ErrorModel ErrorModel::Exact(ErrorRates rates) {
  ErrorModel model;
  model.rates.fill(rates);
  model.weights.fill(1.0 / kLevels);
  return model;
}

ErrorModel ErrorModel::Unknown() {
  constexpr std::array<double, kLevels> kRates = {0.005, 0.02, 0.05, 0.1, 0.2, 0.3};
  constexpr std::array<double, kLevels> kWeights = {0.20, 0.20, 0.25, 0.15, 0.10, 0.10};
  ErrorModel model;
  for (int i = 0; i < kLevels; ++i) model.rates[i] = {kRates[i], kRates[i]};
  model.weights = kWeights;
  return model;
}

ErrorModel ErrorModel::Announced(ErrorRates rates) {
  if (rates.false_yes <= 0 && rates.false_no <= 0) return Exact({});
  constexpr std::array<double, kLevels> kFactors = {0.125, 0.35, 0.7, 1, 2, 4};
  constexpr std::array<double, kLevels> kWeights = {0.05, 0.15, 0.25, 0.35, 0.15, 0.05};
  ErrorModel model;
  for (int i = 0; i < kLevels; ++i) {
    model.rates[i] = {std::min(rates.false_yes * kFactors[i], kWorstRate),
                      std::min(rates.false_no * kFactors[i], kWorstRate)};
  }
  model.weights = kWeights;
  return model;
}

double ErrorModel::Probability(int level, int answers, int meant, int said) const {
  const ErrorRates& r = rates[level];
  if (answers == 2) {
    const double error = meant == 0 ? r.false_no : r.false_yes;
    return meant == said ? 1 - error : error;
  }
  const double error = (r.false_yes + r.false_no) / 2;
  return meant == said ? 1 - error : error / (answers - 1);
}

int SaidAnswer(const std::vector<double>& likelihoods) {
  const auto most = std::max_element(likelihoods.begin(), likelihoods.end());
  const bool tied = std::count(likelihoods.begin(), likelihoods.end(), *most) > 1;
  return static_cast<int>((tied ? likelihoods.end() - 1 : most) - likelihoods.begin());
}

Evidence ErrorModel::Hear(const std::vector<double>& likelihoods) const {
  const int answers = static_cast<int>(likelihoods.size());
  Evidence evidence;
  evidence.said = SaidAnswer(likelihoods);
  evidence.likelihood.resize(likelihoods.size());
  for (int meant = 0; meant < answers; ++meant) {
    for (int level = 0; level < kLevels; ++level) {
      double sum = 0;
      for (int said = 0; said < answers; ++said)
        sum += likelihoods[said] * Probability(level, answers, meant, said);
      evidence.likelihood[meant][level] = sum;
    }
  }
  return evidence;
}

bool ErrorModel::noisy() const {
  return std::any_of(rates.begin(), rates.end(),
                     [](const ErrorRates& r) { return r.false_yes > 0 || r.false_no > 0; });
}

ErrorModel ErrorModel::Learnt(const AnswerCounts& counts) const {
  if (!noisy()) return *this;
  std::array<double, kLevels> log_weights{};
  for (int i = 0; i < kLevels; ++i) {
    log_weights[i] = std::log(std::max(weights[i], 1e-300)) +
                     Term(counts.meant_yes_said_yes, 1 - rates[i].false_no) +
                     Term(counts.meant_yes_said_no, rates[i].false_no) +
                     Term(counts.meant_no_said_yes, rates[i].false_yes) +
                     Term(counts.meant_no_said_no, 1 - rates[i].false_yes) +
                     Term(counts.chose_right, 1 - (rates[i].false_yes + rates[i].false_no) / 2) +
                     Term(counts.chose_wrong, (rates[i].false_yes + rates[i].false_no) / 2);
  }
  const double most = *std::max_element(log_weights.begin(), log_weights.end());
  ErrorModel learnt = *this;
  double sum = 0;
  for (int i = 0; i < kLevels; ++i) sum += learnt.weights[i] = std::exp(log_weights[i] - most);
  for (double& weight : learnt.weights) weight /= sum;
  return learnt;
}

}  // namespace beckon::intention
