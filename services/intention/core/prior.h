// What a user is likely to want before the first answer, learnt from the sessions of the past.
#pragma once

#include <vector>

#include "services/intention/core/policy.h"

namespace beckon::intention {

/// P(pair | scene, history): the task as a Learner predicts it, the instance as an InstanceHabit
/// does, both after living through the last 1000 sessions. One entry a pair, sum 1; empty without
/// pairs. The likeliest instance carries the task's probability, so that to a new user all nearest
/// instances are equally likely.
std::vector<double> PriorOver(const Situation& situation, const UserHistory& history);

/// Lowers the largest entries to `cap` and spreads what they lose over the others in proportion.
void CapPrior(std::vector<double>& prior, double cap);

}  // namespace beckon::intention
