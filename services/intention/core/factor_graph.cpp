#include "services/intention/core/factor_graph.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>

#include "services/intention/core/enumeration.h"

namespace beckon::intention {
namespace {

using enumeration::Link;
using enumeration::Node;
using enumeration::Problem;

/// Nodes that a factor joins, by layer, ascending.
std::array<std::vector<int>, 2> Joined(const std::array<int, 2>& nodes,
                                       const std::vector<FactorGraph::Factor>& factors) {
  std::array<std::vector<int>, 2> joined;
  for (size_t layer = 0; layer < 2; ++layer) {
    std::vector<char> seen(static_cast<size_t>(nodes[layer]), 0);
    for (const auto& factor : factors) seen[static_cast<size_t>(factor.nodes[layer])] = 1;
    for (int node = 0; node < nodes[layer]; ++node) {
      if (seen[static_cast<size_t>(node)]) joined[layer].push_back(node);
    }
  }
  return joined;
}

/// Enumerates `joined` nodes of `layer`; all other nodes are independent given them.
Problem Arrange(const std::array<int, 2>& nodes, const std::vector<FactorGraph::Factor>& factors,
                size_t layer, const std::vector<int>& joined) {
  Problem problem;
  std::vector<int> bits(static_cast<size_t>(nodes[layer]), -1);
  for (const int node : joined) {
    bits[static_cast<size_t>(node)] = static_cast<int>(problem.enumerated.size());
    problem.enumerated.push_back({static_cast<int>(layer), node, {}, {}});
  }
  const size_t other = 1 - layer;
  for (int node = 0; node < nodes[other]; ++node) {
    problem.others.push_back({static_cast<int>(other), node, {}, {}});
  }
  for (size_t i = 0; i < factors.size(); ++i) {
    const PairTable& log = factors[i].log_potential;
    Link link{static_cast<int>(i), bits[static_cast<size_t>(factors[i].nodes[layer])], {}};
    for (size_t node = 0; node < 2; ++node) {
      for (size_t enumerated = 0; enumerated < 2; ++enumerated) {
        link.log_potential[node][enumerated] =
            other == 0 ? log[node + 2 * enumerated] : log[enumerated + 2 * node];
      }
    }
    problem.others[static_cast<size_t>(factors[i].nodes[other])].links.push_back(link);
  }
  // Nodes of the enumerated layer that nothing joins are on their own.
  for (int node = 0; node < nodes[layer]; ++node) {
    if (bits[static_cast<size_t>(node)] < 0) {
      problem.others.push_back({static_cast<int>(layer), node, {}, {}});
    }
  }
  return problem;
}

template <typename Algebra>
void AddLeaves(const std::vector<FactorGraph::Factor>& leaves, std::vector<Node>& nodes) {
  for (Node& node : nodes) {
    if (node.layer != 0) continue;
    for (const auto& leaf : leaves) {
      if (leaf.nodes[0] != node.index) continue;
      for (size_t x = 0; x < 2; ++x) {
        node.log_leaves[x] +=
            Algebra::CombineLogs(leaf.log_potential[x], leaf.log_potential[x + 2]);
      }
    }
  }
}

template <typename Algebra>
Result<Marginals> Enumerate(Problem problem, const std::vector<FactorGraph::Factor>& leaves,
                            Marginals marginals) {
  AddLeaves<Algebra>(leaves, problem.enumerated);
  AddLeaves<Algebra>(leaves, problem.others);
  enumeration::Enumeration<Algebra> states(problem);
  if (!states.SumUp()) {
    return Error{
        "factor graph: every assignment has potential zero, expected one that is possible"};
  }
  const auto of = [&](const Node& node) -> double& {
    return (node.layer == 0 ? marginals.first : marginals.second)[static_cast<size_t>(node.index)];
  };
  for (const Node& node : problem.others) of(node) = states.Marginal(node, marginals.edges);
  const auto by_bit = states.EnumeratedMarginals();
  for (size_t bit = 0; bit < by_bit.size(); ++bit) of(problem.enumerated[bit]) = by_bit[bit];
  return marginals;
}

bool IsLogPotential(const PairTable& table) {
  return std::all_of(table.begin(), table.end(), [](double x) {
    return !std::isnan(x) && x < std::numeric_limits<double>::infinity();
  });
}

}  // namespace

FactorGraph::FactorGraph(int first_nodes, int second_nodes) : nodes_{first_nodes, second_nodes} {}

void FactorGraph::Connect(int first, int second, const PairTable& log_potential) {
  assert(first >= 0 && first < nodes_[0] && second >= 0 && second < nodes_[1]);
  factors_.push_back({{first, second}, log_potential});
}

void FactorGraph::HangLeaf(int first, const PairTable& log_potential) {
  assert(first >= 0 && first < nodes_[0]);
  leaves_.push_back({{first, -1}, log_potential});
}

Result<Marginals> FactorGraph::Infer(Semiring semiring) const {
  for (const auto* list : {&factors_, &leaves_}) {
    for (const Factor& factor : *list) {
      if (IsLogPotential(factor.log_potential)) continue;
      return Error{"factor graph: a log potential of node " + std::to_string(factor.nodes[0]) +
                   " is NaN or +infinity, expected a number or -infinity"};
    }
  }
  const auto joined = Joined(nodes_, factors_);
  const size_t layer = joined[0].size() < joined[1].size() ? 0 : 1;
  if (joined[layer].size() > kMaxEnumerated) {
    return Error{"factor graph: " + std::to_string(joined[0].size()) + " and " +
                 std::to_string(joined[1].size()) + " joined nodes, expected at most " +
                 std::to_string(kMaxEnumerated) + " in one of the layers"};
  }
  const Problem problem = Arrange(nodes_, factors_, layer, joined[layer]);
  Marginals marginals;
  marginals.first.resize(static_cast<size_t>(nodes_[0]));
  marginals.second.resize(static_cast<size_t>(nodes_[1]));
  marginals.edges.resize(factors_.size());
  return semiring == Semiring::kMaxProduct
             ? Enumerate<enumeration::MaxProduct>(problem, leaves_, std::move(marginals))
             : Enumerate<enumeration::SumProduct>(problem, leaves_, std::move(marginals));
}

}  // namespace beckon::intention
