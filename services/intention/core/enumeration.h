// Inference in a two-layer network by going through all states of one layer: the arithmetic behind
// FactorGraph.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "services/intention/core/factor_graph.h"

namespace beckon::intention::enumeration {

inline constexpr double kLogZero = -std::numeric_limits<double>::infinity();

/// How weights of alternatives come together. Weights are logarithms while they are multiplied;
/// FromLog makes of them what Add adds up.
struct MaxProduct {
  static double CombineLogs(double a, double b) { return std::max(a, b); }
  static double FromLog(double log) { return log; }
  static double Add(double a, double b) { return a > b ? a : b; }
  static constexpr double kNothing = kLogZero;
  template <size_t N>
  static std::array<double, N> Normalised(std::array<double, N> weights) {
    const double most = *std::max_element(weights.begin(), weights.end());
    double sum = 0;
    for (double& w : weights) sum += w = std::exp(w - most);
    for (double& w : weights) w /= sum;
    return weights;
  }
};

struct SumProduct {
  static double CombineLogs(double a, double b) {
    const double more = std::max(a, b);
    return more == kLogZero ? kLogZero : more + std::log1p(std::exp(std::min(a, b) - more));
  }
  static double FromLog(double log) { return std::exp(log); }
  static double Add(double a, double b) { return a + b; }
  static constexpr double kNothing = 0;
  template <size_t N>
  static std::array<double, N> Normalised(std::array<double, N> weights) {
    double sum = 0;
    for (const double w : weights) sum += w;
    for (double& w : weights) w /= sum;
    return weights;
  }
};

/// A factor as its node that is not enumerated sees it.
struct Link {
  int factor = 0;
  int bit = 0;                                         // of its enumerated node
  std::array<std::array<double, 2>, 2> log_potential;  // [state of the node][of the enumerated]
};

/// A node by itself.
struct Node {
  int layer = 0;  // 0 or 1
  int index = 0;
  std::array<double, 2> log_leaves{};  // what its leaves say, by its state
  std::vector<Link> links;             // of nodes that are not enumerated
};

struct Problem {
  std::vector<Node> enumerated;  // by bit
  std::vector<Node> others;
};

/// Inference by going through all states of the enumerated nodes; a state is a mask of their bits.
template <typename Algebra>
class Enumeration {
 public:
  explicit Enumeration(const Problem& problem)
      : problem_(problem),
        states_(size_t{1} << problem.enumerated.size()),
        log_total_(states_, 0.0),
        weights_{std::vector<double>(states_), std::vector<double>(states_)} {}

  /// log potential of each state, everything else summed (or maximised) out. False: all are zero.
  bool SumUp() {
    for (size_t bit = 0; bit < problem_.enumerated.size(); ++bit) {
      Multiply(log_total_, static_cast<int>(bit), problem_.enumerated[bit].log_leaves);
    }
    for (const Node& node : problem_.others) {
      Condition(node);
      for (size_t s = 0; s < states_; ++s) {
        log_total_[s] += Algebra::CombineLogs(weights_[0][s], weights_[1][s]);
      }
    }
    best_ = *std::max_element(log_total_.begin(), log_total_.end());
    return best_ > kLogZero;
  }

  /// Marginals of a node given log_total_, and of its factors by (node, enumerated node).
  double Marginal(const Node& node, std::vector<PairTable>& edges) {
    Condition(node);
    for (size_t s = 0; s < states_; ++s) {
      const double others =
          log_total_[s] - best_ - Algebra::CombineLogs(weights_[0][s], weights_[1][s]);
      const bool possible = log_total_[s] > kLogZero;
      for (auto& weights : weights_) {
        weights[s] = Algebra::FromLog(possible ? others + weights[s] : kLogZero);
      }
    }
    for (const Link& link : node.links) {
      const auto [f0, f1] = Split(weights_[0], link.bit);
      const auto [t0, t1] = Split(weights_[1], link.bit);
      const size_t tf = node.layer == 0 ? 1 : 2;  // where the node is T, the enumerated one F
      std::array<double, 4> table = {f0, 0, 0, t1};
      table[tf] = t0;
      table[3 - tf] = f1;
      edges[static_cast<size_t>(link.factor)] = Algebra::Normalised(table);
    }
    std::array<double, 2> sums = {Algebra::kNothing, Algebra::kNothing};
    for (size_t s = 0; s < states_; ++s) {
      sums[0] = Algebra::Add(sums[0], weights_[0][s]);
      sums[1] = Algebra::Add(sums[1], weights_[1][s]);
    }
    return Algebra::Normalised(sums)[1];
  }

  /// Marginals of the enumerated nodes, by bit.
  std::vector<double> EnumeratedMarginals() {
    for (size_t s = 0; s < states_; ++s) weights_[0][s] = Algebra::FromLog(log_total_[s] - best_);
    std::vector<double> marginals;
    for (size_t bit = 0; bit < problem_.enumerated.size(); ++bit) {
      marginals.push_back(Algebra::Normalised(Split(weights_[0], static_cast<int>(bit)))[1]);
    }
    return marginals;
  }

 private:
  /// weights_[x][s] = log potential of the node in state x and its factors, given s.
  void Condition(const Node& node) {
    for (size_t x = 0; x < 2; ++x) {
      std::fill(weights_[x].begin(), weights_[x].end(), node.log_leaves[x]);
      for (const Link& link : node.links) Multiply(weights_[x], link.bit, link.log_potential[x]);
    }
  }

  /// Adds by[0] where a bit of the state is clear and by[1] where it is set.
  void Multiply(std::vector<double>& logs, int bit, const std::array<double, 2>& by) const {
    const size_t half = size_t{1} << bit;
    for (size_t start = 0; start < states_; start += 2 * half) {
      for (size_t s = start; s < start + half; ++s) {
        logs[s] += by[0];
        logs[s + half] += by[1];
      }
    }
  }

  /// Sums over the states in which a bit is clear, and in which it is set.
  std::array<double, 2> Split(const std::vector<double>& weights, int bit) const {
    const size_t half = size_t{1} << bit;
    std::array<double, 2> sums = {Algebra::kNothing, Algebra::kNothing};
    for (size_t start = 0; start < states_; start += 2 * half) {
      for (size_t s = start; s < start + half; ++s) {
        sums[0] = Algebra::Add(sums[0], weights[s]);
        sums[1] = Algebra::Add(sums[1], weights[s + half]);
      }
    }
    return sums;
  }

  const Problem& problem_;
  const size_t states_;
  std::vector<double> log_total_;               // by state
  double best_ = 0;                             // largest of log_total_
  std::array<std::vector<double>, 2> weights_;  // by state of the node at hand, then by state
};

}  // namespace beckon::intention::enumeration
