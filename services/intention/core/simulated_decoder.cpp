#include "services/intention/core/simulated_decoder.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace beckon::intention {
namespace {

/// In (0, 1], the same on every platform.
double Uniform(std::mt19937_64& random) {
  return (static_cast<double>(random() >> 11) + 1) * 0x1.0p-53;
}

/// Box and Muller's.
double Normal(std::mt19937_64& random) {
  const double radius = std::sqrt(-2 * std::log(Uniform(random)));
  return radius * std::cos(2 * std::numbers::pi * Uniform(random));
}

/// P(the score d higher on average is the highest): the integral of phi(x - d) Phi(x)^(k - 1).
double Accuracy(int answers, double d) {
  constexpr double kStep = 0.05, kFar = 8;
  double sum = 0;
  for (double x = -kFar; x <= kFar + d; x += kStep) {
    const double density = std::exp(-(x - d) * (x - d) / 2) / std::sqrt(2 * std::numbers::pi);
    const double below = std::erfc(-x / std::numbers::sqrt2) / 2;
    sum += kStep * density * std::pow(below, answers - 1);
  }
  return sum;
}

double Separation(int answers, double flip) {
  double low = 0, high = 10;
  for (int i = 0; i < 30; ++i) {
    const double d = (low + high) / 2;
    (Accuracy(answers, d) < 1 - flip ? low : high) = d;
  }
  return (low + high) / 2;
}

}  // namespace

std::vector<double> DecodedLikelihoods(int answers, int meant, double flip,
                                       std::mt19937_64& random) {
  std::vector<double> likelihoods(static_cast<size_t>(answers), 0.0);
  if (flip <= 0) {
    likelihoods[static_cast<size_t>(meant)] = 1;
    return likelihoods;
  }
  const double d = Separation(answers, flip);
  for (double& score : likelihoods) score = Normal(random);
  likelihoods[static_cast<size_t>(meant)] += d;
  const double most = *std::max_element(likelihoods.begin(), likelihoods.end());
  for (double& score : likelihoods) score = std::exp(d * (score - most));
  const double sum = std::accumulate(likelihoods.begin(), likelihoods.end(), 0.0);
  for (double& likelihood : likelihoods) likelihood /= sum;
  return likelihoods;
}

}  // namespace beckon::intention
