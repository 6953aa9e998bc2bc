#include "services/ui_bridge/bci/residual.h"

#include <algorithm>
#include <random>

#include "services/ui_bridge/bci/fusion.h"
#include "services/ui_bridge/bci/simulated_decoding.h"

namespace beckon::ui_bridge::bci {
namespace {

constexpr int kQuestions = 600;
constexpr double kMostError = 0.45;
/// Of the errors of a class: no other is never taken for it.
constexpr double kLeastShare = 1e-3;

}  // namespace

Residual SimulateResidual(size_t classes, size_t options, double accuracy,
                          const StoppingConfig& stopping) {
  std::mt19937_64 random(7);  // NOLINT: the same for all
  const double least = 1.05 / static_cast<double>(classes);
  const SimulatedDecoding decoder(classes, std::clamp(accuracy, least, 0.999));
  std::vector<double> prior(classes, 0.0);
  std::fill_n(prior.begin(), options, 1.0);
  int wrong = 0, trials = 0;
  for (int i = 0; i < kQuestions; ++i) {
    const size_t meant = static_cast<size_t>(i) % options;
    Fusion fusion(classes);
    std::vector<double> posterior;
    do {
      fusion.Add(LogLikelihoods(decoder.Draw(meant, random), {.sharpness = 1}));
      posterior = fusion.Posterior(prior);
    } while (ShouldStop(stopping, posterior, {}, fusion.trials()) == Verdict::kNotYet);
    trials += fusion.trials();
    const auto best = std::max_element(posterior.begin(), posterior.end()) - posterior.begin();
    wrong += static_cast<size_t>(best) != meant;
  }
  return {(wrong + 0.5) / (kQuestions + 1), static_cast<double>(trials) / kQuestions};
}

std::vector<std::vector<float>> ResidualConfusion(const Confusion& trial, size_t options,
                                                  double error) {
  std::vector<double> wrong(options, 0.0);  // of single trials, among the options
  double mean = 0;
  for (size_t m = 0; m < options; ++m) {
    for (size_t j = 0; j < options; ++j)
      if (j != m) wrong[m] += trial[m][j] + kLeastShare;
    mean += wrong[m] / static_cast<double>(options);
  }
  std::vector<std::vector<float>> residual(options, std::vector<float>(options, 0.0f));
  for (size_t m = 0; m < options; ++m) {
    const double share = std::min(error * wrong[m] / mean, kMostError);
    double others = 0;
    for (size_t j = 0; j < options; ++j) {
      if (j == m) continue;
      residual[m][j] = static_cast<float>(share * (trial[m][j] + kLeastShare) / wrong[m]);
      others += residual[m][j];
    }
    residual[m][m] = static_cast<float>(1 - others);
  }
  return residual;
}

}  // namespace beckon::ui_bridge::bci
