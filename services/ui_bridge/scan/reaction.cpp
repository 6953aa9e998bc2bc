#include "services/ui_bridge/scan/reaction.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace beckon::ui_bridge::scan {
namespace {

constexpr double kMadOfNormal = 1.4826;  // standard deviation of a normal / its median deviation
constexpr Utime kStep_us = 50'000;

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

}  // namespace

void ReactionTimes::Add(Utime reaction_us) {
  if (reaction_us <= 0) return;
  logs_.push_back(std::log(static_cast<double>(reaction_us)));
  if (logs_.size() > config_.kept) logs_.pop_front();
  ++since_asked_;
}

void ReactionTimes::Chosen() {
  undone_.push_back(false);
  if (undone_.size() > config_.kept) undone_.pop_front();
}

void ReactionTimes::Undone() {
  if (!undone_.empty()) undone_.back() = true;
}

void ReactionTimes::ScanTimeChanged() { undone_.clear(); }

std::optional<ReactionEstimate> ReactionTimes::Estimate() const {
  if (logs_.empty()) return {};
  const std::vector<double> logs(logs_.begin(), logs_.end());
  const double mu = Median(logs);
  std::vector<double> deviations;
  for (const double value : logs) deviations.push_back(std::abs(value - mu));
  const double sigma = kMadOfNormal * Median(deviations);
  const double mean = std::exp(mu + sigma * sigma / 2);
  ReactionEstimate estimate;
  estimate.presses = logs.size();
  estimate.mean_us = static_cast<Utime>(mean);
  estimate.spread_us = static_cast<Utime>(mean * std::sqrt(std::exp(sigma * sigma) - 1));
  if (!undone_.empty()) {
    estimate.undone = static_cast<double>(std::ranges::count(undone_, true)) /
                      static_cast<double>(undone_.size());
  }
  return estimate;
}

std::optional<ScanSuggestion> ReactionTimes::Suggest(Utime scan_us) const {
  const auto estimate = Estimate();
  if (!estimate || estimate->presses < config_.least || since_asked_ < config_.least) return {};
  ScanSuggestion suggestion{.scan_us = 0, .because_undone = false, .estimate = *estimate};
  // Presses that come too late fall on the next entry and look quick: errors outweigh the rule.
  const double current = static_cast<double>(scan_us);
  double wanted = static_cast<double>(estimate->mean_us) / config_.share;
  if (estimate->undone >= config_.many_undone && undone_.size() >= config_.least &&
      wanted < current * config_.slower) {
    wanted = current * config_.slower;
    suggestion.because_undone = true;
  }
  const Utime rounded = std::llround(wanted / kStep_us) * kStep_us;
  suggestion.scan_us = std::clamp(rounded, config_.shortest_us, config_.longest_us);
  const double change = std::abs(static_cast<double>(suggestion.scan_us) - current) / current;
  if (change < config_.notable) return {};
  return suggestion;
}

}  // namespace beckon::ui_bridge::scan
