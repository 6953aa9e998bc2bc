// What a user is likely to want before the first answer, learnt from the sessions of the past.
#pragma once

#include <vector>

#include "services/intention/core/policy.h"

namespace beckon::intention {

struct PriorConfig {
  double pseudo_count = 1.0 / 12;  // of every (category, action) pair
  double forgetting = 0.95;        // weight of evidence a session older
  double repeat_prior = 1;         // pseudo-counts of "the same as last time" ...
  double switch_prior = 1;         // ... and of "something else"
  double rank_prior = 1;           // pseudo-count of the whole distribution over instance ranks
  double rank_decay = 0.3;         // of that distribution from one rank to the next
};

/// P(pair | scene, history): (n[category, action] + pseudo_count) * g(instance rank), mixed with
/// "the same pair as last time" at a weight learnt from the user's own repeats. Evidence weighs
/// forgetting^age, age counted in the user's sessions. One entry a pair, sum 1; empty without
/// pairs.
std::vector<double> PriorOver(const Situation& situation, const UserHistory& history,
                              const PriorConfig& config = {});

/// Lowers the largest entries to `cap` and spreads what they lose over the others in proportion.
void CapPrior(std::vector<double>& prior, double cap);

}  // namespace beckon::intention
