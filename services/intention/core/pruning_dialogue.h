// A dialogue over a list of queries in a fixed order of preference that answers prune, as the
// dissertation's and the baselines do.
#pragma once

#include <vector>

#include "services/intention/core/policy.h"

namespace beckon::intention {

/// Asks the first query that is left. A yes to an action or object query keeps only its full
/// queries, a no removes all that mention it; a no to a full query removes it and the single
/// queries on its object and its action; a yes to it accepts its candidate.
class PruningDialogue : public Dialogue {
 public:
  struct Query {
    Question question;
    int action = -1;  // of action and full queries
    int object = -1;  // of object and full queries: an instance or a category, as the policy has it
    double probability = 0;  // for people
  };

  explicit PruningDialogue(std::vector<Query> queries) : left_(std::move(queries)) {}

  std::optional<Question> Ask() override;
  void Hear(const Question& question, const Evidence& evidence) override;
  std::optional<int> Accepted() const override { return accepted_; }
  Ending End() const override {
    return left_.empty() && !accepted_ ? Ending::kNone : Ending::kOpen;
  }
  Belief CurrentBelief() const override;

 private:
  std::vector<Query> left_;
  std::optional<int> accepted_;
};

}  // namespace beckon::intention
