// Groups patches by signed evidence on their common borders.
#pragma once

#include <span>
#include <vector>

namespace beckon::perception {

/// What speaks for (positive) or against (negative) two nodes being of one object: the mean of
/// `evidence` over a border of `length`.
struct SignedEdge {
  int a = 0, b = 0;
  float evidence = 0;
  float length = 0;
};

/// Merges the two neighbouring groups with the largest mean evidence along their whole border,
/// again and again, while that is positive. A single wrong edge thus joins nothing: it is outvoted
/// by the rest of the border (average linkage on signed graphs: Bailoni et al., "GASP, a
/// Generalized Framework for Agglomerative Clustering of Signed Graphs", 2022). Ties go to the edge
/// that comes first. Returns the group of each node, numbered from 0 in order of their first nodes.
std::vector<int> ClusterSignedGraph(std::span<const float> sizes,
                                    std::span<const SignedEdge> edges);

}  // namespace beckon::perception
