// What the trials of one question say together: the sum of their log-likelihoods. The prior of the
// question decides when to stop and is never part of what is answered, since whoever asks has it.
#pragma once

#include <cstddef>
#include <vector>

namespace beckon::ui_bridge::bci {

class Fusion {
 public:
  explicit Fusion(size_t classes = 0) : logs_(classes, 0.0) {}

  /// One a class.
  void Add(const std::vector<double>& log_likelihoods);

  int trials() const { return trials_; }
  size_t classes() const { return logs_.size(); }

  /// P(class | trials) from `prior` (one a class, >= 0, some > 0; 0: not on offer); sums to 1.
  std::vector<double> Posterior(const std::vector<double>& prior) const;
  /// P(trials | class) of the first `n` classes, scaled to sum 1.
  std::vector<double> Likelihoods(size_t n) const;

 private:
  std::vector<double> logs_;
  int trials_ = 0;
};

}  // namespace beckon::ui_bridge::bci
