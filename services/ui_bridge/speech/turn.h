// What to do with what was heard: a pure rule of who may do what, and how sure it has to be.
#pragma once

#include <vector>

#include "services/ui_bridge/speech/judgement.h"

namespace beckon::ui_bridge::speech {

struct TurnConfig {
  double accept = 0.6;  // least probability of a command
  double stop = 0.2;    // of "stop": a false alarm costs a word, a miss may cost more
  double resume = 0.8;  // of "resume": only on purpose
};

struct Decision {
  enum class Kind { kNothing, kNotUnderstood, kStop, kCommand };
  Kind kind = Kind::kNothing;
  Command command;                  // where kind is kCommand
  std::vector<double> likelihoods;  // of the question's options, where the command is one of them
};

/// `ended` is false for what may go on: then only stop counts. `options` of the question that
/// stands, 0 where none does.
Decision Decide(const Heard& heard, const Grammar& grammar, bool ended, size_t options,
                const TurnConfig& config);

}  // namespace beckon::ui_bridge::speech
