// Platt's sigmoid after Lin, Lin and Weng (2007), "A note on Platt's probabilistic outputs".
#include <cmath>

#include "services/perception/train_svm.h"

namespace beckon::perception {
namespace {

/// The regularised targets of Platt's eq. for the two classes.
struct Problem {
  const std::vector<double>& decisions;
  const std::vector<bool>& positive;
  double high = 1, low = 0;

  double Target(size_t i) const { return positive[i] ? high : low; }

  /// Negative log-likelihood, in the form that neither overflows nor cancels.
  double Loss(double a, double b) const {
    double loss = 0;
    for (size_t i = 0; i < decisions.size(); ++i) {
      const double x = decisions[i] * a + b;
      loss += x >= 0 ? Target(i) * x + std::log1p(std::exp(-x))
                     : (Target(i) - 1) * x + std::log1p(std::exp(x));
    }
    return loss;
  }
};

struct Derivatives {
  double h11 = 1e-12, h22 = 1e-12, h21 = 0, g1 = 0, g2 = 0;
};

Derivatives Differentiate(const Problem& problem, double a, double b) {
  Derivatives d;
  for (size_t i = 0; i < problem.decisions.size(); ++i) {
    const double f = problem.decisions[i];
    const double p = Sigmoid{static_cast<float>(a), static_cast<float>(b)}.Probability(f);
    const double curvature = p * (1 - p);
    const double slope = problem.Target(i) - p;
    d.h11 += f * f * curvature;
    d.h22 += curvature;
    d.h21 += f * curvature;
    d.g1 += f * slope;
    d.g2 += slope;
  }
  return d;
}

}  // namespace

Sigmoid FitSigmoid(const std::vector<double>& decisions, const std::vector<bool>& positive) {
  double positives = 0;
  for (const bool p : positive) positives += p;
  const double negatives = static_cast<double>(positive.size()) - positives;
  const Problem problem{decisions, positive, (positives + 1) / (positives + 2),
                        1 / (negatives + 2)};
  double a = 0, b = std::log((negatives + 1) / (positives + 1));
  double loss = problem.Loss(a, b);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Derivatives d = Differentiate(problem, a, b);
    if (std::abs(d.g1) < 1e-5 && std::abs(d.g2) < 1e-5) break;
    const double determinant = d.h11 * d.h22 - d.h21 * d.h21;
    const double step_a = -(d.h22 * d.g1 - d.h21 * d.g2) / determinant;
    const double step_b = -(-d.h21 * d.g1 + d.h11 * d.g2) / determinant;
    const double descent = d.g1 * step_a + d.g2 * step_b;
    double step = 1;
    for (; step >= 1e-10; step /= 2) {
      const double new_loss = problem.Loss(a + step * step_a, b + step * step_b);
      if (new_loss < loss + 1e-4 * step * descent) {
        a += step * step_a, b += step * step_b;
        loss = new_loss;
        break;
      }
    }
    if (step < 1e-10) break;
  }
  return {static_cast<float>(a), static_cast<float>(b)};
}

}  // namespace beckon::perception
