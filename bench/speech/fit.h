// Fits the recogniser's judgement to what was measured of many utterances.
#pragma once

#include <optional>
#include <vector>

#include "services/ui_bridge/speech/judgement.h"

namespace beckon::bench {

/// What was measured of one utterance: of each command's likeliest phrase.
struct Example {
  std::vector<ui_bridge::speech::Features> commands;
  std::optional<size_t> said;  // which of them it was; nothing: none
};

/// Multinomial logistic regression with "none" as one class of fixed odds, by Newton's method with
/// a ridge penalty on standardised features. Utterances inside and outside of the grammar weigh the
/// same in total.
ui_bridge::speech::JudgementModel Fit(const std::vector<Example>& examples, double ridge);

}  // namespace beckon::bench
