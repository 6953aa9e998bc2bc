// What is left of a decoder's errors once trials were repeated, and how many that takes: what a
// front end announces, since its answers are fused ones.
#pragma once

#include <cstddef>
#include <vector>

#include "services/ui_bridge/bci/evidence.h"
#include "services/ui_bridge/bci/stopping.h"

namespace beckon::ui_bridge::bci {

struct Residual {
  double error = 0;        // P(the likeliest option of an answer is not the one meant), 0..1
  double repetitions = 1;  // of a question, on average
};

/// Of questions with `options` (2 .. classes) answers, alike beforehand, by a decoder that is right
/// in `accuracy` of its trials: simulated, always with the same random numbers.
Residual SimulateResidual(size_t classes, size_t options, double accuracy,
                          const StoppingConfig& stopping);

/// A confusion of `options` fused answers that are wrong at `error` on average. Which ones are
/// taken for which is as in `trial`, the confusion of single trials (of as many classes or more).
std::vector<std::vector<float>> ResidualConfusion(const Confusion& trial, size_t options,
                                                  double error);

}  // namespace beckon::ui_bridge::bci
