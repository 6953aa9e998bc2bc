#include "services/intention/core/exact_policy.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>
#include <limits>
#include <numeric>
#include <set>

namespace beckon::intention {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr int kMostOutlined = 5;  // objects of a set

using Pairs = uint32_t;  // set of pairs: bits are indices of Situation::pairs

/// Expected costs are not normalised: they are weighed by the probability of the set.
class SubsetProgram {
 public:
  SubsetProgram(const Situation& situation, const std::vector<double>& prior,
                const Interface& interface, QueryFamilies families)
      : situation_(situation), interface_(interface), all_(families == QueryFamilies::kAll) {
    const Pairs count = Pairs{1} << situation.pair_count();
    probability_.assign(count, 0);
    for (Pairs set = 1; set < count; ++set)
      probability_[set] = probability_[set & (set - 1)] + prior[std::countr_zero(set)];
    ListPropositions();
    if (interface.Choices()) ListPartitions();
    cost_.assign(count, 0);
    for (Pairs set = 1; set < count; ++set) cost_[set] = Best(set);
  }

  double Cost() const { return cost_.back(); }

 private:
  Pairs PairsOf(uint64_t actions, uint64_t objects) const {
    Pairs set = 0;
    for (int i = 0; i < situation_.pair_count(); ++i) {
      if (Proposition{actions, objects, -1}.Holds(situation_.pairs[i])) set |= Pairs{1} << i;
    }
    return set;
  }

  std::vector<uint64_t> Categories() const {
    std::set<uint64_t> masks;
    for (const Instance& object : situation_.objects) {
      if (object.category >= 0) masks.insert(situation_.MaskOf(object.category));
    }
    return {masks.begin(), masks.end()};
  }

  void ListPropositions() {
    const uint64_t objects = uint64_t{1} << situation_.objects.size();
    std::set<Pairs> sets;
    for (int i = 0; i < situation_.pair_count(); ++i) {
      const Pair& pair = situation_.pairs[i];
      sets.insert(PairsOf(uint64_t{1} << pair.action, kAny));
      sets.insert(PairsOf(kAny, uint64_t{1} << pair.object));
      for (int j = 0; all_ && j < i; ++j)
        sets.insert(
            PairsOf(uint64_t{1} << pair.action | uint64_t{1} << situation_.pairs[j].action, kAny));
    }
    if (all_) {
      for (const uint64_t category : Categories()) sets.insert(PairsOf(kAny, category));
      for (uint64_t mask = 1; mask < objects; ++mask) {
        if (std::popcount(mask) <= kMostOutlined || IsPrefix(mask))
          sets.insert(PairsOf(kAny, mask));
      }
    }
    propositions_.assign(sets.begin(), sets.end());
  }

  /// Whether these are the nearest objects, or those furthest to the left.
  bool IsPrefix(uint64_t mask) const {
    bool nearest = true, leftmost = true;
    for (size_t in = 0; in < situation_.objects.size(); ++in) {
      for (size_t out = 0; out < situation_.objects.size(); ++out) {
        if ((mask >> in & 1) == 0 || (mask >> out & 1) != 0) continue;
        const Instance &a = situation_.objects[in], &b = situation_.objects[out];
        nearest = nearest && a.distance_m < b.distance_m;
        leftmost = leftmost && a.lateral_m < b.lateral_m;
      }
    }
    return nearest || leftmost;
  }

  void ListPartitions() {
    std::vector<Pairs> pairs, actions, objects, categories;
    for (int i = 0; i < situation_.pair_count(); ++i) pairs.push_back(Pairs{1} << i);
    for (int action = 0; action < kMaxActions; ++action)
      actions.push_back(PairsOf(uint64_t{1} << action, kAny));
    for (size_t object = 0; object < situation_.objects.size(); ++object)
      objects.push_back(PairsOf(kAny, uint64_t{1} << object));
    partitions_ = {pairs, actions, objects};
    if (!all_) return;
    for (const uint64_t category : Categories()) categories.push_back(PairsOf(kAny, category));
    partitions_.push_back(categories);
  }

  double Best(Pairs set) const {
    double best = kNever;
    for (Pairs rest = set; rest != 0; rest &= rest - 1) {
      const Pairs pair = rest & (~rest + 1);
      best = std::min(best, YesNo(set, pair));
    }
    for (const Pairs proposition : propositions_) {
      const Pairs in = set & proposition;
      if (in != 0 && in != set) best = std::min(best, YesNo(set, in) + cost_[in]);
    }
    for (const auto& partition : partitions_) best = std::min(best, BestChoice(set, partition));
    return best;
  }

  /// Without what is still to be asked after a yes.
  double YesNo(Pairs set, Pairs in) const {
    const Pairs out = set & ~in;
    return probability_[in] * interface_.Seconds(2, 0) +
           probability_[out] * interface_.Seconds(2, 1) + cost_[out];
  }

  /// Of the m likeliest sets of a partition, each an option.
  double BestChoice(Pairs set, const std::vector<Pairs>& partition) const {
    std::vector<Pairs> options;
    for (const Pairs part : partition) {
      if ((set & part) != 0) options.push_back(set & part);
    }
    std::stable_sort(options.begin(), options.end(),
                     [&](Pairs a, Pairs b) { return probability_[a] > probability_[b]; });
    double best = kNever;
    const int most = std::min(static_cast<int>(options.size()), interface_.max_options - 1);
    for (int m = 2; m <= most; ++m) {
      double cost = 0;
      Pairs none = set;
      for (int i = 0; i < m; ++i) {
        none &= ~options[i];
        cost += probability_[options[i]] * interface_.Seconds(m + 1, i);
        if (std::popcount(options[i]) > 1) cost += cost_[options[i]];
      }
      cost += probability_[none] * interface_.Seconds(m + 1, m) + cost_[none];
      best = std::min(best, cost);
    }
    return best;
  }

  const Situation& situation_;
  const Interface interface_;
  const bool all_;
  std::vector<double> probability_;             // by set
  std::vector<Pairs> propositions_;             // of yes/no questions
  std::vector<std::vector<Pairs>> partitions_;  // of choices
  std::vector<double> cost_;                    // by set
};

class TreeWalk {
 public:
  TreeWalk(const Situation& situation, const Interface& interface, const Asker& asker)
      : situation_(situation), interface_(interface), asker_(asker) {}

  /// `p`: sums to `mass`, the probability of getting here.
  void Walk(const std::vector<double>& p, double mass, int depth) {
    constexpr int kDeepest = 1000;
    std::vector<double> posterior(p);
    for (double& x : posterior) x /= mass;
    const auto question = depth < kDeepest ? asker_(posterior) : std::nullopt;
    if (!question) {
      cost.questions = cost.seconds = kNever;
      return;
    }
    ++cost.asked;
    cost.questions += mass;
    for (int answer = 0; answer < question->answers(); ++answer) {
      std::vector<double> left(p.size(), 0.0);
      for (size_t i = 0; i < p.size(); ++i) {
        if (p[i] > 0 && question->Meant(situation_.pairs[i]) == answer) left[i] = p[i];
      }
      const double probability = std::accumulate(left.begin(), left.end(), 0.0);
      if (probability <= 0) continue;
      cost.seconds += probability * interface_.Seconds(question->answers(), answer);
      if (question->Accepts(answer) < 0) Walk(left, probability, depth + 1);
    }
  }

  PolicyCost cost;

 private:
  const Situation& situation_;
  const Interface& interface_;
  const Asker& asker_;
};

}  // namespace

double BestCode(std::vector<double> probabilities) {
  std::sort(probabilities.rbegin(), probabilities.rend());
  const int n = static_cast<int>(probabilities.size());
  std::vector<double> left(n + 1, 0.0);  // of the candidates from i on
  for (int i = n - 1; i >= 0; --i) left[i] = left[i + 1] + probabilities[i];
  // cost[i][w]: of the levels still to come where the i likeliest candidates have their words and w
  // nodes are to be expanded. Each has a 1-child, which may be a word, and a 0-child, which may
  // not.
  std::vector<std::vector<double>> cost(n + 1, std::vector<double>(n + 1, kNever));
  std::fill(cost[n].begin(), cost[n].end(), 0.0);
  for (int i = n - 1; i >= 0; --i) {
    for (int w = n - i; w > 0; --w) {
      double best = kNever;
      for (int words = 0; words <= w; ++words) {
        const int next = std::min(2 * w - words, n - i - words);
        if (words > 0 || next > w) best = std::min(best, cost[i + words][next]);
      }
      cost[i][w] = left[i] + best;
    }
  }
  return n == 0 ? 0 : cost[0][1];
}

double BestSeconds(const Situation& situation, const std::vector<double>& prior,
                   const Interface& interface, QueryFamilies families) {
  assert(situation.pair_count() <= kMostExactPairs);
  return SubsetProgram(situation, prior, interface, families).Cost();
}

PolicyCost CostOf(const Situation& situation, const std::vector<double>& prior,
                  const Interface& interface, const Asker& asker) {
  TreeWalk walk(situation, interface, asker);
  walk.Walk(prior, std::accumulate(prior.begin(), prior.end(), 0.0), 0);
  return walk.cost;
}

}  // namespace beckon::intention
