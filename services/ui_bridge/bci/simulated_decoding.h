// A decoder of brain signals without a brain: class probabilities that are right as often as told.
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <vector>

namespace beckon::ui_bridge::bci {

/// Each class has a score, normal with variance 1, that of the class attended to d higher, and d
/// such that it is the highest with probability `accuracy`. The probabilities are Bayes' from those
/// scores and a uniform prior, exp(d score) scaled, so that they are honest; raised to `sharpness`,
/// above 1 the decoder is surer than it ought to be.
class SimulatedDecoding {
 public:
  /// `classes` >= 2, `accuracy` 1/classes .. 0.999, `sharpness` > 0.
  SimulatedDecoding(size_t classes, double accuracy, double sharpness = 1);

  /// Of one trial; nothing attended to: all classes alike. The same engine gives the same.
  std::vector<double> Draw(std::optional<size_t> attended, std::mt19937_64& random) const;

  double separation() const { return separation_; }  // d

 private:
  size_t classes_;
  double separation_;
  double sharpness_;
};

/// Uniform in [0, 1), the same on every platform.
double Uniform(std::mt19937_64& random);

}  // namespace beckon::ui_bridge::bci
