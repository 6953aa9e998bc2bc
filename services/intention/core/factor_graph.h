// Exact inference in a network of binary nodes in two layers: every factor joins a node of the
// first layer and one of the second, as those of an object-action network do.
#pragma once

#include <array>
#include <vector>

#include "services/base/result.h"

namespace beckon::intention {

/// By the states (first, second) of two binary nodes: FF TF FT TT.
using PairTable = std::array<double, 4>;

enum class Semiring {
  kMaxProduct,  // max-marginals: of the best assignment with a state, normalised over the states
  kSumProduct   // marginals
};

struct Marginals {
  std::vector<double> first;     // P(T) by node of the first layer
  std::vector<double> second;    // P(T) by node of the second layer
  std::vector<PairTable> edges;  // by factor, in the order of Connect; each sums to 1
};

/// Nodes of one layer are independent given the other's, so that enumerating the states of the
/// smaller one is exact: with n of its nodes joined to anything, it costs 2^n additions a factor.
/// Potentials are general, zeros among them, and kept as logarithms (-infinity is zero).
class FactorGraph {
 public:
  /// Most joined nodes in the smaller layer: 4,096 states, some 2 ms with 64 nodes in the other.
  static constexpr int kMaxEnumerated = 12;

  struct Factor {
    std::array<int, 2> nodes;  // of the first layer, of the second (-1: a leaf)
    PairTable log_potential;
  };

  FactorGraph(int first_nodes, int second_nodes);

  /// Joins a node of the first layer and one of the second by a factor. Two nodes may be joined
  /// more than once.
  void Connect(int first, int second, const PairTable& log_potential);
  /// Hangs a node that nobody observes or asks about on one of the first layer: a factor by the
  /// states (node, leaf).
  void HangLeaf(int first, const PairTable& log_potential);

  /// Fails where both layers have more than kMaxEnumerated joined nodes, where a log potential is
  /// NaN or +infinity, and where every assignment has potential zero.
  Result<Marginals> Infer(Semiring semiring) const;

 private:
  std::array<int, 2> nodes_;  // by layer
  std::vector<Factor> factors_;
  std::vector<Factor> leaves_;
};

}  // namespace beckon::intention
