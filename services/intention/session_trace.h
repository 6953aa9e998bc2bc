// What an evaluated session looks like from inside, for people to read.
#pragma once

#include <map>
#include <ostream>
#include <string>

#include "services/intention/core/evaluation.h"

namespace beckon::intention {

/// Writes each session as it is lived: the likeliest tasks before the first answer, then for every
/// question its words, why it is asked, what each answer would lead to, the answer, and the
/// likeliest tasks after it.
class SessionTrace : public SessionWatcher {
 public:
  /// Both must outlive the trace.
  SessionTrace(const Affordances& affordances, std::ostream& out)
      : affordances_(affordances), out_(out) {}

  void Begun(const SessionView& view, const Belief& belief) override;
  void Answered(const SessionView& view, const AnsweredQuestion& answered) override;
  void Ended(const SessionView& view, const SessionOutcome& outcome) override;

 private:
  void WriteLikeliest(const char* label, const SessionView& view, const Belief& belief,
                      bool with_habits);

  const Affordances& affordances_;
  std::ostream& out_;
  std::map<std::string, int> sessions_;  // by user
  std::vector<double> prior_;
  int questions_ = 0;
};

}  // namespace beckon::intention
