#include "services/intention/core/memory.h"

#include "services/intention/core/answer_errors.h"

namespace beckon::intention {

UserHistory ToHistory(const std::vector<SessionRecord>& sessions, const Affordances& affordances) {
  UserHistory history;
  for (const SessionRecord& session : sessions) {
    PastSession past;
    past.category = affordances.FindCategory(session.category);
    past.action = affordances.FindAction(session.action);
    if (past.category < 0 || past.action < 0) continue;
    past.rank = session.instance;
    past.device = session.device;
    for (const AnswerRecord& answer : session.answers) {
      Count(past.answers, answer.meant_yes, answer.yes > answer.no);
    }
    history.push_back(std::move(past));
  }
  return history;
}

}  // namespace beckon::intention
