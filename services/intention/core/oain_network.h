// The dissertation's Object-Action Intention Network in closed form.
//
// Binary nodes for actions and object instances; a factor per (object, action) edge with states FF
// TF FT TT. While every factor has FF = TF = FT (which the learning rule keeps), max-product belief
// propagation has the closed form below; r = f_TT / f_FF of an edge, R_x the product of r over x's
// edges.
#pragma once

#include <vector>

#include "services/intention/core/policy.h"

namespace beckon::intention {

/// Max-marginals of a situation.
class OainNetwork {
 public:
  OainNetwork(const Affordances& affordances, const Situation& situation,
              const UserHistory& history);

  /// P(x) = 1 / (1 + 1/R_x).
  double Action(int action) const;
  double Object(int object) const;
  /// P(TT) = 1 / (1 + 1/R_o + 1/R_a + r / (R_o R_a)).
  double Full(int pair) const;

  /// log r of an edge after it was learnt n times: f_TT += 1, then the factor normalised, from the
  /// prior 1 1 1 5 gives r = 8 * 2^n - 3.
  static double LogRatio(int learnt);

 private:
  const Situation& situation_;
  std::vector<double> log_r_;         // by pair
  std::vector<double> log_R_action_;  // by action
  std::vector<double> log_R_object_;  // by object
};

}  // namespace beckon::intention
