// Choosing the next question: the one that leaves the fewest answers to be expected.
#pragma once

#include <optional>
#include <vector>

#include "services/intention/core/error_model.h"
#include "services/intention/core/policy.h"

namespace beckon::intention {

struct Choice {
  Question question;
  double expected_questions = 0;  // this one included
};

/// Expected number of answers until an accepted full query, from the entropy of the posterior
/// (bits): L = H + 0.45 + 0.55 exp(-2.4 H), within 0.2 % of the exact optimum as a lookahead's
/// leaf. L(0) = 1: the confirming answer. With noise a bit costs 1 / capacity answers.
double RemainingQuestions(double entropy_bits, double capacity_bits);

/// Capacity of a yes/no answer, bits, for rates averaged to a symmetric channel.
double Capacity(const ErrorRates& rates);

/// One-step lookahead over the families. `posterior`: one entry a pair, sum <= 1 (what is missing
/// is "none of them"). A yes to a full query ends the session where the pair's posterior reaches
/// `accept_posterior`. Nothing where no pair has any probability.
std::optional<Choice> ChooseQuestion(const Situation& situation,
                                     const std::vector<double>& posterior, const ErrorRates& rates,
                                     QueryFamilies families, double accept_posterior);

}  // namespace beckon::intention
