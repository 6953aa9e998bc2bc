// The best that any way of asking can do where answers are never wrong: what policies are measured
// against.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "services/intention/core/interface.h"
#include "services/intention/core/policy.h"
#include "services/intention/core/question.h"

namespace beckon::intention {

/// Most pairs that BestSeconds enumerates the subsets of.
inline constexpr int kMostExactPairs = 16;

/// Fewest expected yes/no answers where any set of candidates may be asked about and the last
/// answer is a yes to the wanted candidate alone: the best binary code whose words all end in a 1
/// (Chan & Golin 2000, "A dynamic programming algorithm for constructing optimal 1-ended binary
/// prefix-free codes"). O(n^3). `probabilities`: >= 0; the cost is scaled by their sum.
double BestCode(std::vector<double> probabilities);

/// Expected seconds until an accepted full query with the best of all policies that ask the
/// questions of `families` and, among sets of objects, any of up to five; at an interface with
/// choices also for the m likeliest pairs, actions, objects or categories, m from 2 on. By dynamic
/// programming over the subsets of pairs. `prior`: one entry a pair, at most kMostExactPairs.
double BestSeconds(const Situation& situation, const std::vector<double>& prior,
                   const Interface& interface, QueryFamilies families);

/// The question that a policy asks at a posterior (one entry a pair, sum 1).
using Asker = std::function<std::optional<Question>(const std::vector<double>& posterior)>;

struct PolicyCost {
  double questions = 0;  // expected
  double seconds = 0;    // expected
  int asked = 0;         // questions of the whole tree
};

/// What a policy really costs: its whole tree of questions and answers is walked. Candidates that
/// it never accepts cost infinitely much.
PolicyCost CostOf(const Situation& situation, const std::vector<double>& prior,
                  const Interface& interface, const Asker& asker);

}  // namespace beckon::intention
