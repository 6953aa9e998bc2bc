#include "services/ui_bridge/bci/evidence.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace beckon::ui_bridge::bci {

Confusion EvenConfusion(size_t classes, double accuracy) {
  const double other = (1 - accuracy) / static_cast<double>(classes - 1);
  Confusion confusion(classes, std::vector<double>(classes, other));
  for (size_t i = 0; i < classes; ++i) confusion[i][i] = accuracy;
  return confusion;
}

Status CheckProbabilities(const std::vector<double>& probabilities, size_t classes) {
  if (probabilities.size() != classes) {
    return Error{"expected " + std::to_string(classes) + " probabilities, one a class, found " +
                 std::to_string(probabilities.size())};
  }
  double sum = 0;
  for (const double p : probabilities) {
    if (!(p >= 0 && p <= 1 + 1e-3))
      return Error{"expected probabilities from 0 to 1, found " + std::to_string(p)};
    sum += p;
  }
  if (std::abs(sum - 1) > 1e-3)
    return Error{"expected probabilities that sum to 1, found a sum of " + std::to_string(sum)};
  return {};
}

std::vector<double> Softened(const std::vector<double>& probabilities) {
  const double least = kLeast / static_cast<double>(probabilities.size());
  std::vector<double> softened = probabilities;
  for (double& p : softened) p = (p + least) / (1 + kLeast);
  return softened;
}

std::vector<double> LogLikelihoods(const std::vector<double>& probabilities,
                                   const DecoderModel& model) {
  const std::vector<double> p = Softened(probabilities);
  std::vector<double> logs(p.size());
  for (size_t m = 0; m < p.size(); ++m) {
    logs[m] = model.sharpness * std::log(p[m]);
    if (model.habit <= 0 || model.confusion.size() != p.size()) continue;
    double sum = 0;
    for (size_t j = 0; j < p.size(); ++j) sum += model.confusion[m][j] * p[j];
    logs[m] += model.habit * std::log(sum);
  }
  const double most = *std::max_element(logs.begin(), logs.end());
  for (double& log : logs) log -= most;
  return logs;
}

}  // namespace beckon::ui_bridge::bci
