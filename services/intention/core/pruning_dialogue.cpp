#include "services/intention/core/pruning_dialogue.h"

#include <algorithm>

namespace beckon::intention {

std::optional<Question> PruningDialogue::Ask() {
  if (left_.empty()) return std::nullopt;
  return left_.front().question;
}

void PruningDialogue::Hear(const Question& question, const Evidence& evidence) {
  const auto found = std::find_if(left_.begin(), left_.end(),
                                  [&](const Query& query) { return query.question == question; });
  if (found == left_.end()) return;
  const Query heard = *found;
  const bool yes = evidence.said != question.none();
  const bool full = question.kind == QuestionKind::kFull;
  if (full && yes) {
    if (question.Accepts(0) >= 0) accepted_ = question.Accepts(0);
    return;
  }
  std::erase_if(left_, [&](const Query& query) {
    if (query.question == question) return true;
    const bool query_full = query.question.kind == QuestionKind::kFull;
    const bool same_action = query.action >= 0 && query.action == heard.action;
    const bool same_object = query.object >= 0 && query.object == heard.object;
    if (full) return !query_full && (same_action || same_object);
    const bool mentions = same_action || same_object;
    return yes ? !(query_full && mentions) : mentions;
  });
}

Belief PruningDialogue::CurrentBelief() const {
  Belief belief;
  for (const Query& query : left_) {
    const int pair = query.question.Accepts(0);
    if (pair < 0) continue;
    ++belief.possible_pairs;
    if (query.probability > belief.best_posterior) {
      belief.best_posterior = query.probability;
      belief.best_pair = pair;
    }
  }
  if (accepted_) belief = {*accepted_, 1, 1, 0, 0, {}};
  belief.expected_questions = accepted_ ? 0 : static_cast<double>(left_.size()) / 2;
  belief.expected_seconds = belief.expected_questions;
  return belief;
}

}  // namespace beckon::intention
