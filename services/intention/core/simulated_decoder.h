// A decoder that is never sure, as those of brain signals are: a likelihood for every answer.
#pragma once

#include <random>
#include <vector>

namespace beckon::intention {

/// Each answer's score is normal with variance 1, that of the meant one d higher, and d such that
/// another has the highest score with probability `flip` (0..0.5, below (answers - 1) / answers).
/// Returns the likelihoods of the scores by answer meant, exp(d score) scaled to sum 1; one-hot
/// where flip is 0.
std::vector<double> DecodedLikelihoods(int answers, int meant, double flip,
                                       std::mt19937_64& random);

}  // namespace beckon::intention
