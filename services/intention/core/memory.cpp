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
    past.utime = session.utime;
    if (!session.present.empty()) past.present.assign(affordances.categories().size(), 0);
    for (const auto& [name, count] : session.present) {
      if (const int category = affordances.FindCategory(name); category >= 0)
        past.present[static_cast<size_t>(category)] = count;
    }
    for (const AnswerRecord& answer : session.answers) {
      if (answer.fate == AnswerFate::kDropped) continue;
      Count(past.answers[answer.device], static_cast<int>(answer.likelihoods.size()), answer.meant,
            SaidAnswer(answer.likelihoods));
    }
    history.push_back(std::move(past));
  }
  return history;
}

}  // namespace beckon::intention
