// The policies by themselves; MakePolicy chooses among them by name.
#pragma once

#include <memory>

#include "services/intention/core/policy.h"

namespace beckon::intention {

/// The dissertation's: max-marginals of its network, its learning rule at rate `lambda`, its
/// pruning.
std::unique_ptr<Policy> MakeOainPolicy(const Affordances& affordances, double lambda = 1);
/// Its count baseline, which learnt once and never again.
std::unique_ptr<Policy> MakeCountPolicy(const Affordances& affordances);
std::unique_ptr<Policy> MakeRandomScenePolicy();
std::unique_ptr<Policy> MakeRandomPolicy(const Affordances& affordances);

struct AdaptiveConfig {
  QueryFamilies families = QueryFamilies::kAll;
  double accept_posterior =
      0.998;  // a task needs an accepted full query and this posterior; a margin over 99 %
  double noisy_prior_cap =
      0.9;                // most that a pair may have before the first answer, where input is noisy
  double none_prior = 0;  // that the user wants none of the pairs, where input is noisy
};

/// Bayesian: learnt prior, answers as evidence, one-step lookahead. See adaptive_policy.cpp.
std::unique_ptr<Policy> MakeAdaptivePolicy(const AdaptiveConfig& config);

}  // namespace beckon::intention
