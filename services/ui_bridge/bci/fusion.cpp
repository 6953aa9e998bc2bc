#include "services/ui_bridge/bci/fusion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beckon::ui_bridge::bci {

void Fusion::Add(const std::vector<double>& log_likelihoods) {
  for (size_t i = 0; i < logs_.size(); ++i) logs_[i] += log_likelihoods[i];
  ++trials_;
}

std::vector<double> Fusion::Posterior(const std::vector<double>& prior) const {
  std::vector<double> posterior(logs_.size(), 0.0);
  double most = -std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < logs_.size(); ++i)
    if (prior[i] > 0) most = std::max(most, logs_[i] + std::log(prior[i]));
  double sum = 0;
  for (size_t i = 0; i < logs_.size(); ++i)
    if (prior[i] > 0) sum += posterior[i] = std::exp(logs_[i] + std::log(prior[i]) - most);
  for (double& p : posterior) p /= sum;
  return posterior;
}

std::vector<double> Fusion::Likelihoods(size_t n) const {
  std::vector<double> offered(logs_.size(), 0.0);
  std::fill_n(offered.begin(), n, 1.0);
  std::vector<double> likelihoods = Posterior(offered);
  likelihoods.resize(n);
  return likelihoods;
}

}  // namespace beckon::ui_bridge::bci
