#include "services/intention/core/oain_network.h"

#include <cmath>
#include <map>
#include <utility>

namespace beckon::intention {

OainNetwork::OainNetwork(const Affordances& affordances, const Situation& situation,
                         const UserHistory& history)
    : situation_(situation),
      log_R_action_(affordances.actions().size(), 0.0),
      log_R_object_(situation.objects.size(), 0.0) {
  std::map<std::pair<int, int>, int> learnt;
  for (const PastSession& past : history) ++learnt[{past.category, past.action}];
  for (const Pair& pair : situation.pairs) {
    const auto found = learnt.find({situation.objects[pair.object].category, pair.action});
    log_r_.push_back(LogRatio(found == learnt.end() ? 0 : found->second));
    log_R_action_[pair.action] += log_r_.back();
    log_R_object_[pair.object] += log_r_.back();
  }
}

double OainNetwork::LogRatio(int learnt) {
  // log(8 * 2^n - 3), written so that it does not overflow.
  return std::log(8.0) + learnt * std::log(2.0) + std::log1p(-3.0 / 8.0 * std::exp2(-learnt));
}

double OainNetwork::Action(int action) const { return 1 / (1 + std::exp(-log_R_action_[action])); }
double OainNetwork::Object(int object) const { return 1 / (1 + std::exp(-log_R_object_[object])); }

double OainNetwork::Full(int pair) const {
  const double log_R_o = log_R_object_[situation_.pairs[pair].object];
  const double log_R_a = log_R_action_[situation_.pairs[pair].action];
  return 1 /
         (1 + std::exp(-log_R_o) + std::exp(-log_R_a) + std::exp(log_r_[pair] - log_R_o - log_R_a));
}

}  // namespace beckon::intention
