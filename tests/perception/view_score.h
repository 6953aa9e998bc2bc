// How often views are categorised right, and how surely.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "services/perception/categoriser.h"

namespace beckon::perception {

struct ViewScore {
  int n = 0, right = 0;
  double log_loss = 0;  // sum of -log p(truth)

  /// `said` has an answer.
  void Add(const Categorisation& said, const std::string& truth) {
    ++n;
    right += said.probabilities.front().first == truth ? 1 : 0;
    for (const auto& [name, p] : said.probabilities) {
      if (name == truth) log_loss -= std::log(std::max(p, 1e-6f));
    }
  }
};

}  // namespace beckon::perception
