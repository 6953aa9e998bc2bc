// What one trial says: from a decoder's class probabilities to how likely the signal is under each
// class. A decoder's word is not taken as it comes; its calibration says how much it is worth.
#pragma once

#include <cstddef>
#include <vector>

#include "services/base/result.h"

namespace beckon::ui_bridge::bci {

/// Rows: the class meant, columns: the class decoded; each row sums to 1.
using Confusion = std::vector<std::vector<double>>;

/// `accuracy` (0..1) of `classes` (>= 2) right, the rest spread evenly.
Confusion EvenConfusion(size_t classes, double accuracy);

/// How to read a decoder: log P(signal | m) = sharpness log p_m + habit log (sum_j C_mj p_j) + c.
/// An honest decoder has sharpness 1 and habit 0, and then Bayes' rule from its uniform prior is
/// all there is. Sharpness below 1 (a temperature above 1: Guo, Pleiss, Sun, Weinberger, "On
/// calibration of modern neural networks", 2017) is for one that is surer than it ought to be;
/// habit is for one that says little of itself but errs in known ways, as one that names a class
/// and no more does.
struct DecoderModel {
  double sharpness = 0.8;  // >= 0
  double habit = 0;        // >= 0
  Confusion confusion;     // of as many classes as are decoded; not used where habit is 0
  // By how much, on average, log P(signal | m) of the class meant is above the mean of the others.
  double gap = 2;
};

/// Fails unless there are `classes` of them, each finite and 0 .. 1, that sum to 1 (+- 1e-3).
Status CheckProbabilities(const std::vector<double>& probabilities, size_t classes);

/// Nothing is impossible: each probability raised by kLeast / k before it is used, and scaled.
inline constexpr double kLeast = 0.04;
std::vector<double> Softened(const std::vector<double>& probabilities);

/// One a class, the likeliest 0. `probabilities` as CheckProbabilities wants them.
std::vector<double> LogLikelihoods(const std::vector<double>& probabilities,
                                   const DecoderModel& model);

}  // namespace beckon::ui_bridge::bci
