#include "services/ui_bridge/bci/simulated_decoding.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beckon::ui_bridge::bci {
namespace {

/// Box and Muller's.
double Normal(std::mt19937_64& random) {
  const double radius = std::sqrt(-2 * std::log(1 - Uniform(random)));
  return radius * std::cos(2 * std::numbers::pi * Uniform(random));
}

/// P(the score that is d higher is the highest): the integral of phi(x - d) Phi(x)^(k - 1).
double Accuracy(size_t classes, double d) {
  constexpr double kStep = 0.05, kFar = 8;
  const double scale = kStep / std::sqrt(2 * std::numbers::pi);
  double sum = 0;
  for (double x = -kFar; x <= kFar + d; x += kStep) {
    const double below = std::erfc(-x / std::numbers::sqrt2) / 2;
    sum += scale * std::exp(-(x - d) * (x - d) / 2) *
           std::pow(below, static_cast<double>(classes - 1));
  }
  return sum;
}

}  // namespace

double Uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1.0p-53; }

SimulatedDecoding::SimulatedDecoding(size_t classes, double accuracy, double sharpness)
    : classes_(classes), sharpness_(sharpness) {
  double low = 0, high = 10;
  for (int i = 0; i < 40; ++i) {
    const double d = (low + high) / 2;
    (Accuracy(classes, d) < accuracy ? low : high) = d;
  }
  separation_ = (low + high) / 2;
}

std::vector<double> SimulatedDecoding::Draw(std::optional<size_t> attended,
                                            std::mt19937_64& random) const {
  std::vector<double> scores(classes_);
  for (double& score : scores) score = Normal(random);
  if (attended) scores[*attended] += separation_;
  const double most = *std::max_element(scores.begin(), scores.end());
  double sum = 0;
  for (double& score : scores) sum += score = std::exp(sharpness_ * separation_ * (score - most));
  for (double& score : scores) score /= sum;
  return scores;
}

}  // namespace beckon::ui_bridge::bci
