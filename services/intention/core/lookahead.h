// Choosing the next question: the one that leaves the fewest seconds to be expected.
#pragma once

#include <optional>
#include <vector>

#include "services/intention/core/interface.h"
#include "services/intention/core/policy.h"

namespace beckon::intention {

struct Choice {
  Question question;
  double expected_questions = 0;  // until an accepted full query, this one included
  double expected_seconds = 0;    // that they take
  int priced = 0;                 // questions that were looked at: the work done
};

/// Expected number of yes/no answers until an accepted full query, from the entropy of the
/// posterior (bits): see QuestionCost::Remaining.
double RemainingQuestions(double entropy_bits, double capacity_bits);

/// The best question of the families at an interface whose answers are wrong at `rates`. Each
/// is priced one step ahead; the best few are followed a second step. Where several cost the same
/// within 0.2 %, it is the one that is understood most easily. `posterior`: one entry a pair, sum
/// <= 1 (what is missing is "none of them"). A yes to a full query ends the session where the
/// pair's posterior reaches `accept_posterior`. Nothing where no pair has any probability.
std::optional<Choice> ChooseQuestion(const Situation& situation,
                                     const std::vector<double>& posterior,
                                     const Interface& interface, const ErrorRates& rates,
                                     QueryFamilies families, double accept_posterior);

}  // namespace beckon::intention
