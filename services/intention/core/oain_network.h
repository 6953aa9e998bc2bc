// The dissertation's Object-Action Intention Network.
//
// Binary nodes for actions, object instances and distances. A factor per (object, action) with
// states FF TF FT TT, at first 1 1 1 5; learning a pair is f_TT += lambda; factors are normalised
// to sum 1. A factor per object joins it to its distance node. Queries are ranked by max-marginals.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "services/intention/core/factor_graph.h"
#include "services/intention/core/policy.h"

namespace beckon::intention {

/// How often each (category, action) was learnt.
using LearntPairs = std::map<std::pair<int, int>, int>;

LearntPairs CountPairs(const UserHistory& history);

/// Max-marginals of T, of TT for pairs.
struct OainMarginals {
  std::vector<double> actions;  // by action; of those that are in the situation
  std::vector<double> objects;  // by object
  std::vector<double> pairs;    // by pair
};

class OainNetwork {
 public:
  /// `lambda` > 0 is the learning rate; `situation` must outlive the network.
  OainNetwork(const Affordances& affordances, const Situation& situation, const LearntPairs& learnt,
              double lambda = 1);

  /// By exact inference in the whole network, up to 12 actions or 12 objects (FactorGraph); by the
  /// closed form where both are more.
  OainMarginals MaxMarginals() const;

  /// The same, from FF = TF = FT, which learning keeps, and from a distance factor that says
  /// nothing of what is wanted. With r = f_TT / f_FF of an edge and R_x the product of r over x's
  /// edges, P(x) = 1 / (1 + 1/R_x) and P(TT) = 1 / (1 + 1/R_o + 1/R_a + r / (R_o R_a)).
  OainMarginals ClosedForm() const;

  /// log of an (object, action) factor that was learnt n times, by (object, action): after n times
  /// f_FF = (1 + lambda)^-n / 8 and f_TT = 1 - 3 f_FF.
  static PairTable LogFactor(int learnt, double lambda);
  /// log of the factor of an object at `distance_m` and its distance node, T is "near". The object
  /// is near up to half the largest distance and 2 cm more. Symmetric: as nobody observes the node,
  /// it makes no object likelier than another.
  static PairTable LogDistanceFactor(double distance_m, double largest_m);

 private:
  const int actions_;
  const Situation& situation_;
  std::vector<PairTable> log_factors_;  // by pair
};

}  // namespace beckon::intention
