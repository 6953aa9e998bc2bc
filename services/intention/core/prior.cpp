#include "services/intention/core/prior.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace beckon::intention {
namespace {

/// Older sessions weigh less than 0.95^200 = 3.5e-5.
constexpr size_t kOldest = 200;

/// Decayed counts of a user's past.
struct Counts {
  std::map<std::pair<int, int>, double> pairs;  // (category, action)
  std::map<int, double> ranks;
  double repeats = 0;
  double switches = 0;
};

bool SameTask(const PastSession& a, const PastSession& b) {
  return a.category == b.category && a.action == b.action;
}

Counts CountPast(const UserHistory& history, double forgetting) {
  Counts counts;
  const size_t oldest = history.size() - std::min(history.size(), kOldest);
  double weight = 1;
  for (size_t i = history.size(); i-- > oldest; weight *= forgetting) {
    const PastSession& past = history[i];
    counts.pairs[{past.category, past.action}] += weight;
    counts.ranks[past.rank] += weight;
    if (i > 0) (SameTask(past, history[i - 1]) ? counts.repeats : counts.switches) += weight;
  }
  return counts;
}

/// The pair of the last session in this scene: its rank where it is there, else the nearest; or -1.
int FindLast(const Situation& situation, const UserHistory& history) {
  if (history.empty()) return -1;
  const PastSession& last = history.back();
  const int same = situation.Find(last.category, last.rank, last.action);
  return same >= 0 ? same : situation.Find(last.category, 1, last.action);
}

}  // namespace

std::vector<double> PriorOver(const Situation& situation, const UserHistory& history,
                              const PriorConfig& config) {
  std::vector<double> prior;
  if (situation.pairs.empty()) return prior;
  const Counts counts = CountPast(history, config.forgetting);
  for (const Pair& pair : situation.pairs) {
    const Instance& object = situation.objects[pair.object];
    const auto n = counts.pairs.find({object.category, pair.action});
    const auto m = counts.ranks.find(object.rank);
    const double g =
        (m == counts.ranks.end() ? 0 : m->second) +
        config.rank_prior * (1 - config.rank_decay) * std::pow(config.rank_decay, object.rank - 1);
    prior.push_back(((n == counts.pairs.end() ? 0 : n->second) + config.pseudo_count) * g);
  }
  const double sum = std::accumulate(prior.begin(), prior.end(), 0.0);
  const int last = FindLast(situation, history);
  const double repeat =
      last < 0 ? 0
               : (counts.repeats + config.repeat_prior) /
                     (counts.repeats + counts.switches + config.repeat_prior + config.switch_prior);
  for (double& p : prior) p *= (1 - repeat) / sum;
  if (last >= 0) prior[last] += repeat;
  return prior;
}

void CapPrior(std::vector<double>& prior, double cap) {
  const auto most = std::max_element(prior.begin(), prior.end());
  if (prior.size() < 2 || *most <= cap) return;
  // Only one entry can exceed a cap of at least 1/2.
  const double rest = 1 - *most;
  const double spread = (1 - cap) / std::max(rest, 1e-300);
  const bool others = rest > 1e-12;
  for (auto p = prior.begin(); p != prior.end(); ++p) {
    if (p == most) continue;
    *p = others ? *p * spread : (1 - cap) / static_cast<double>(prior.size() - 1);
  }
  *most = cap;
}

}  // namespace beckon::intention
