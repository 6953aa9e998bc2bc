// Renyi's entropy.
#include "services/perception/categoriser_confidence.h"

#include <algorithm>
#include <cmath>

namespace beckon::perception {

float RenyiConfidence(const std::vector<float>& probabilities) {
  if (probabilities.size() < 2) return 0;
  double squares = 0;
  for (const float p : probabilities) squares += static_cast<double>(p) * p;
  if (!(squares > 0)) return 0;
  const double entropy = -std::log2(squares);
  const double most = std::log2(static_cast<double>(probabilities.size()));
  return static_cast<float>(std::clamp(1 - entropy / most, 0.0, 1.0));
}

}  // namespace beckon::perception
