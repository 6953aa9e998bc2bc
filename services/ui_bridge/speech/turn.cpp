#include "services/ui_bridge/speech/turn.h"

namespace beckon::ui_bridge::speech {

Decision Decide(const Heard& heard, const Grammar& grammar, bool ended, size_t options,
                const TurnConfig& config) {
  using Kind = Decision::Kind;
  Decision decision;
  for (size_t i = 0; i < heard.commands.size() && i < grammar.commands.size(); ++i) {
    if (grammar.commands[i].kind == CommandKind::kStop && heard.commands[i] >= config.stop) {
      decision.kind = Kind::kStop;
      return decision;
    }
  }
  if (!ended) return decision;
  decision.kind = Kind::kNotUnderstood;
  if (!heard.best || *heard.best >= grammar.commands.size()) return decision;
  const Command& best = grammar.commands[*heard.best];
  const double least = best.kind == CommandKind::kResume ? config.resume : config.accept;
  // Options that may be confused with each other are evidence together: their likelihoods say so.
  double probability = heard.commands[*heard.best];
  if (best.kind == CommandKind::kOption) {
    probability = 0;
    for (size_t i = 0; i < grammar.commands.size(); ++i) {
      if (grammar.commands[i].kind == CommandKind::kOption) probability += heard.commands[i];
    }
    if (heard.commands[*heard.best] < probability / 2) return decision;
  }
  if (probability < least) return decision;
  decision.likelihoods = OptionLikelihoods(heard, grammar, options);
  if (best.kind == CommandKind::kOption && decision.likelihoods.empty()) return decision;
  decision.kind = Kind::kCommand;
  decision.command = best;
  return decision;
}

}  // namespace beckon::ui_bridge::speech
