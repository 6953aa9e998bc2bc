#include "services/intention/core/factor_graph.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace beckon::intention {
namespace {

/// A network that remembers what it was made of, to be solved by trying all assignments.
struct Example {
  struct Factor {
    int first, second;  // second < 0: a leaf
    PairTable potential;
  };
  int first_nodes, second_nodes;
  std::vector<Factor> factors;

  FactorGraph Graph() const {
    FactorGraph graph(first_nodes, second_nodes);
    for (const Factor& factor : factors) {
      PairTable log;
      for (size_t i = 0; i < 4; ++i) log[i] = std::log(factor.potential[i]);
      if (factor.second < 0) {
        graph.HangLeaf(factor.first, log);
      } else {
        graph.Connect(factor.first, factor.second, log);
      }
    }
    return graph;
  }

  /// Marginals of all nodes and edges by going through all states of everything, leaves too.
  Marginals BruteForce(Semiring semiring) const {
    int leaves = 0;
    for (const Factor& factor : factors) leaves += factor.second < 0;
    const int bits = first_nodes + second_nodes + leaves;
    std::vector<std::array<double, 2>> nodes(static_cast<size_t>(first_nodes + second_nodes));
    Marginals found;
    for (uint32_t state = 0; state < uint32_t{1} << bits; ++state) {
      const auto is = [&](int bit) -> size_t { return state >> bit & 1; };
      double value = 1;
      int leaf = first_nodes + second_nodes;
      std::vector<size_t> edge_states;
      for (const Factor& factor : factors) {
        const size_t other = factor.second < 0 ? is(leaf++) : is(first_nodes + factor.second);
        const size_t index = is(factor.first) + 2 * other;
        value *= factor.potential[index];
        if (factor.second >= 0) edge_states.push_back(index);
      }
      const auto add = [&](double& sum) {
        sum = semiring == Semiring::kMaxProduct ? std::max(sum, value) : sum + value;
      };
      for (int i = 0; i < first_nodes + second_nodes; ++i) add(nodes[i][is(i)]);
      found.edges.resize(edge_states.size());
      for (size_t i = 0; i < edge_states.size(); ++i) add(found.edges[i][edge_states[i]]);
    }
    for (int i = 0; i < first_nodes + second_nodes; ++i) {
      (i < first_nodes ? found.first : found.second)
          .push_back(nodes[i][1] / (nodes[i][0] + nodes[i][1]));
    }
    for (PairTable& edge : found.edges) {
      const double sum = edge[0] + edge[1] + edge[2] + edge[3];
      for (double& p : edge) p /= sum;
    }
    return found;
  }
};

double Uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1.0p-53; }

Example RandomExample(std::mt19937_64& random, int first_nodes, int second_nodes, double zeros) {
  Example example{first_nodes, second_nodes, {}};
  const auto table = [&] {
    PairTable potential;
    for (double& p : potential) p = Uniform(random) < zeros ? 0 : std::exp(6 * Uniform(random) - 3);
    return potential;
  };
  for (int first = 0; first < first_nodes; ++first) {
    for (int second = 0; second < second_nodes; ++second) {
      if (random() % 3 != 0) example.factors.push_back({first, second, table()});
    }
    if (random() % 4 == 0) example.factors.push_back({first, -1, table()});
  }
  return example;
}

void ExpectNear(const Marginals& a, const Marginals& b, double tolerance) {
  ASSERT_EQ(a.first.size(), b.first.size());
  ASSERT_EQ(a.second.size(), b.second.size());
  ASSERT_EQ(a.edges.size(), b.edges.size());
  for (size_t i = 0; i < a.first.size(); ++i) EXPECT_NEAR(a.first[i], b.first[i], tolerance);
  for (size_t i = 0; i < a.second.size(); ++i) EXPECT_NEAR(a.second[i], b.second[i], tolerance);
  for (size_t i = 0; i < a.edges.size(); ++i) {
    for (size_t j = 0; j < 4; ++j) EXPECT_NEAR(a.edges[i][j], b.edges[i][j], tolerance);
  }
}

class FactorGraphBy : public testing::TestWithParam<Semiring> {};

TEST_P(FactorGraphBy, EqualsBruteForceOnRandomNetworks) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 60; ++trial) {
    // Wider in either layer, so that either is enumerated.
    const int first = 1 + static_cast<int>(random() % 6);
    const Example example = RandomExample(random, first, 7 - first, 0);
    const auto found = example.Graph().Infer(GetParam());
    ASSERT_TRUE(found.ok());
    ExpectNear(*found, example.BruteForce(GetParam()), 1e-12);
  }
}

TEST_P(FactorGraphBy, EqualsBruteForceWithZerosInPotentials) {
  std::mt19937_64 random(2);
  int impossible = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const int first = 1 + static_cast<int>(random() % 5);
    const Example example = RandomExample(random, first, 6 - first, 0.2);
    const Marginals truth = example.BruteForce(GetParam());
    const auto found = example.Graph().Infer(GetParam());
    const bool possible = std::isfinite(truth.first[0]);
    ASSERT_EQ(found.ok(), possible);
    if (possible) {
      ExpectNear(*found, truth, 1e-12);
    } else {
      ++impossible;
      EXPECT_NE(found.error().message.find("every assignment has potential zero"),
                std::string::npos);
    }
  }
  EXPECT_GT(impossible, 0);
  EXPECT_LT(impossible, 80);
}

TEST_P(FactorGraphBy, KnowsASingleFactor) {
  FactorGraph graph(1, 1);
  graph.Connect(0, 0, {std::log(1.0), std::log(2.0), std::log(3.0), std::log(4.0)});
  const auto found = graph.Infer(GetParam());
  ASSERT_TRUE(found.ok());
  const bool sums = GetParam() == Semiring::kSumProduct;
  EXPECT_NEAR(found->first[0], sums ? 6.0 / 10 : 4.0 / 7, 1e-15);
  EXPECT_NEAR(found->second[0], sums ? 7.0 / 10 : 4.0 / 6, 1e-15);
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(found->edges[0][i], static_cast<double>(i + 1) / 10, 1e-15);
  }
}

TEST_P(FactorGraphBy, IgnoresTheScaleOfFactors) {
  std::mt19937_64 random(3);
  const Example example = RandomExample(random, 4, 3, 0);
  FactorGraph scaled(4, 3);
  for (const auto& factor : example.factors) {
    const double shift = 1000 * Uniform(random) - 500;  // exp(shift) would not be a double
    PairTable log;
    for (size_t i = 0; i < 4; ++i) log[i] = std::log(factor.potential[i]) + shift;
    factor.second < 0 ? scaled.HangLeaf(factor.first, log)
                      : scaled.Connect(factor.first, factor.second, log);
  }
  ExpectNear(*scaled.Infer(GetParam()), *example.Graph().Infer(GetParam()), 1e-11);
}

TEST_P(FactorGraphBy, SaysTheSameWithItsLayersExchanged) {
  std::mt19937_64 random(4);
  Example example = RandomExample(random, 5, 3, 0);
  std::erase_if(example.factors, [](const auto& factor) { return factor.second < 0; });
  Example exchanged{3, 5, example.factors};
  for (auto& factor : exchanged.factors) {
    std::swap(factor.first, factor.second);
    std::swap(factor.potential[1], factor.potential[2]);
  }
  Marginals found = *exchanged.Graph().Infer(GetParam());
  std::swap(found.first, found.second);
  for (PairTable& edge : found.edges) std::swap(edge[1], edge[2]);
  ExpectNear(found, *example.Graph().Infer(GetParam()), 1e-13);
}

TEST_P(FactorGraphBy, IsUndecidedAboutNodesThatNothingJoins) {
  FactorGraph graph(2, 20);
  graph.Connect(0, 19, {0, 0, 0, 1});
  graph.HangLeaf(1, {std::log(1.0), std::log(9.0), std::log(1.0), std::log(9.0)});
  const auto found = graph.Infer(GetParam());
  ASSERT_TRUE(found.ok());
  EXPECT_NEAR(found->second[0], 0.5, 1e-15);
  EXPECT_NEAR(found->first[1], 0.9, 1e-15);
}

TEST_P(FactorGraphBy, EnumeratesTheSmallerLayerAndRefusesTwoLargeOnes) {
  constexpr int kMost = FactorGraph::kMaxEnumerated;
  FactorGraph narrow(64, 8), large(kMost + 1, kMost + 1);
  for (int i = 0; i < 64; ++i) narrow.Connect(i, i % 8, {0, 0, 0, 1});
  for (int i = 0; i < kMost; ++i) large.Connect(i, i, {0, 0, 0, 1});
  EXPECT_TRUE(narrow.Infer(GetParam()).ok());
  EXPECT_TRUE(large.Infer(GetParam()).ok());  // one node of each layer is alone
  large.Connect(kMost, kMost, {0, 0, 0, 1});
  const auto refused = large.Infer(GetParam());
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("13 and 13 joined nodes, expected at most 12"),
            std::string::npos);
}

TEST_P(FactorGraphBy, RefusesPotentialsThatAreNone) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    FactorGraph graph(3, 1);
    graph.HangLeaf(2, {0, 0, bad, 0});
    const auto refused = graph.Infer(GetParam());
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().message.find("of node 2 is NaN"), std::string::npos);
  }
}

INSTANTIATE_TEST_SUITE_P(Semirings, FactorGraphBy,
                         testing::Values(Semiring::kMaxProduct, Semiring::kSumProduct),
                         [](const auto& tested) {
                           return tested.param == Semiring::kMaxProduct ? "MaxProduct"
                                                                        : "SumProduct";
                         });

}  // namespace
}  // namespace beckon::intention
