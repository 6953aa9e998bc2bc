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

bool StopWatch::Hear(const std::vector<double>& log_likelihoods, size_t stop) {
  double others = 0;
  for (size_t i = 0; i < log_likelihoods.size(); ++i)
    if (i != stop) others += std::exp(log_likelihoods[i]);
  others /= static_cast<double>(log_likelihoods.size() - 1);
  const double ratio = log_likelihoods[stop] - std::log(std::max(others, 1e-300));
  sum_ = std::min(std::max(0.0, sum_ + ratio), limit_);
  return sum_ >= limit_;
}

}  // namespace beckon::ui_bridge::bci
