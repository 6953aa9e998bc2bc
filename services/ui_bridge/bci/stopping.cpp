#include "services/ui_bridge/bci/stopping.h"

#include <algorithm>
#include <cmath>

namespace beckon::ui_bridge::bci {

Verdict ShouldStop(const StoppingConfig& config, const std::vector<double>& posterior,
                   const std::vector<bool>& ends, int repetitions) {
  if (repetitions < config.min_repetitions) return Verdict::kNotYet;
  const auto best = std::max_element(posterior.begin(), posterior.end());
  const auto likeliest = static_cast<size_t>(best - posterior.begin());
  const bool last = likeliest < ends.size() && ends[likeliest];
  if (*best >= (last ? std::max(config.threshold, config.final_threshold) : config.threshold))
    return Verdict::kSure;
  return repetitions >= config.max_repetitions ? Verdict::kEnough : Verdict::kNotYet;
}

StopWatch::StopWatch(const StopWatchConfig& config)
    : limit_(std::log(config.trials_per_false_stop)) {}

bool StopWatch::Hear(const std::vector<double>& log_likelihoods, size_t stop, double gap,
                     bool asked) {
  const double others = static_cast<double>(log_likelihoods.size() - 1);
  double likelihood = 0, log = 0;  // means of the others
  for (size_t i = 0; i < log_likelihoods.size(); ++i) {
    if (i == stop) continue;
    likelihood += std::exp(log_likelihoods[i]) / others;
    log += log_likelihoods[i] / others;
  }
  const double against_others = log_likelihoods[stop] - std::log(std::max(likelihood, 1e-300));
  const double against_nothing = (log_likelihoods[stop] - log - gap / 2) / (1 + 1 / others);
  const double ratio = asked ? against_others : std::min(against_others, against_nothing);
  sum_ = std::min(std::max(0.0, sum_ + ratio), limit_);
  return sum_ >= limit_;
}

}  // namespace beckon::ui_bridge::bci
