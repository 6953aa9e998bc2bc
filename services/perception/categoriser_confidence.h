// How sure a probability distribution is.
#pragma once

#include <vector>

namespace beckon::perception {

/// 1 - H2 / log2 k, where H2 = -log2 sum p^2 is Renyi's entropy of order 2 (eq. 4.21): 0 for k
/// equal probabilities, 1 for certainty. 0 where there are fewer than two.
float RenyiConfidence(const std::vector<float>& probabilities);

}  // namespace beckon::perception
