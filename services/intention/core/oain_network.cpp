#include "services/intention/core/oain_network.h"

#include <algorithm>
#include <cmath>

namespace beckon::intention {

LearntPairs CountPairs(const UserHistory& history) {
  LearntPairs learnt;
  for (const PastSession& past : history) ++learnt[{past.category, past.action}];
  return learnt;
}

OainNetwork::OainNetwork(const Affordances& affordances, const Situation& situation,
                         const LearntPairs& learnt, double lambda)
    : actions_(static_cast<int>(affordances.actions().size())), situation_(situation) {
  for (const Pair& pair : situation.pairs) {
    const auto found = learnt.find({situation.objects[pair.object].category, pair.action});
    log_factors_.push_back(LogFactor(found == learnt.end() ? 0 : found->second, lambda));
  }
}

PairTable OainNetwork::LogFactor(int learnt, double lambda) {
  const double log_f_FF = -std::log(8.0) - learnt * std::log1p(lambda);
  return {log_f_FF, log_f_FF, log_f_FF, std::log1p(-3 * std::exp(log_f_FF))};
}

PairTable OainNetwork::LogDistanceFactor(double distance_m, double largest_m) {
  const double share = largest_m > 0 ? distance_m / largest_m : 0;
  const bool near = distance_m <= largest_m / 2 + 0.02;
  const double agrees = std::log(near ? 1 - share : share);
  const double differs = std::log(near ? share : 1 - share);
  return {agrees, differs, differs, agrees};
}

OainMarginals OainNetwork::MaxMarginals() const {
  FactorGraph graph(static_cast<int>(situation_.objects.size()), actions_);
  for (size_t i = 0; i < log_factors_.size(); ++i) {
    graph.Connect(situation_.pairs[i].object, situation_.pairs[i].action, log_factors_[i]);
  }
  double largest_m = 0;
  for (const Instance& object : situation_.objects) {
    largest_m = std::max(largest_m, object.distance_m);
  }
  for (size_t i = 0; i < situation_.objects.size(); ++i) {
    graph.HangLeaf(static_cast<int>(i),
                   LogDistanceFactor(situation_.objects[i].distance_m, largest_m));
  }
  auto exact = graph.Infer(Semiring::kMaxProduct);
  if (!exact) return ClosedForm();
  OainMarginals marginals{std::move(exact->second), std::move(exact->first), {}};
  for (const PairTable& edge : exact->edges) marginals.pairs.push_back(edge[3]);
  return marginals;
}

OainMarginals OainNetwork::ClosedForm() const {
  std::vector<double> log_r, log_R_action(static_cast<size_t>(actions_), 0.0);
  std::vector<double> log_R_object(situation_.objects.size(), 0.0);
  for (size_t i = 0; i < log_factors_.size(); ++i) {
    log_r.push_back(log_factors_[i][3] - log_factors_[i][0]);
    log_R_action[situation_.pairs[i].action] += log_r.back();
    log_R_object[situation_.pairs[i].object] += log_r.back();
  }
  OainMarginals marginals;
  for (const double log_R : log_R_action) marginals.actions.push_back(1 / (1 + std::exp(-log_R)));
  for (const double log_R : log_R_object) marginals.objects.push_back(1 / (1 + std::exp(-log_R)));
  for (size_t i = 0; i < log_r.size(); ++i) {
    const double log_R_o = log_R_object[situation_.pairs[i].object];
    const double log_R_a = log_R_action[situation_.pairs[i].action];
    marginals.pairs.push_back(
        1 / (1 + std::exp(-log_R_o) + std::exp(-log_R_a) + std::exp(log_r[i] - log_R_o - log_R_a)));
  }
  return marginals;
}

}  // namespace beckon::intention
