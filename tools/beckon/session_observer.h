// What happens in one user's conversations, put together from what passes on the bus.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/base/utime.h"

namespace beckon::tool {

struct GivenAnswer {
  int64_t query_id = 0;
  msg::QueryKind kind = msg::QueryKind::kFull;
  std::string question;
  std::string answer;  // the likeliest option's words
  int object_id = 0;   // of a kWhatIsIt
};

/// One conversation. Times are of when messages were heard, but for answer_to_query_ms, which goes
/// by their own stamps.
struct SessionRecord {
  int number = 0;  // from 1, in the order of their ends
  std::string session_id;
  Utime requested = 0;
  std::optional<Utime> first_query;
  Utime ended = 0;
  std::vector<GivenAnswer> answers;        // each question's first, as given by the user
  std::vector<double> answer_to_query_ms;  // from an answer to the question that follows it
  std::optional<msg::Task> task;           // of a confirmed session
  std::string outcome;                     // why there is none

  int CategoryQuestions() const;
};

/// Feed it every message of the five types; repetitions are recognised. A session ends with its
/// TASK or with ABANDONED.
class SessionObserver {
 public:
  SessionObserver(std::string user, std::function<void(const SessionRecord&)> on_end);

  void OnSession(const msg::Session& message, Utime now);
  void OnQuery(const msg::Query& query, Utime now);
  void OnAnswer(const msg::Answer& answer, Utime now);
  void OnTask(const msg::Task& task, Utime now);

  int begun() const { return static_cast<int>(began_.size()); }
  int ended() const { return ended_count_; }
  /// Questions heard, in all sessions.
  int questions() const { return questions_; }
  /// When something new was last heard.
  Utime last_news() const { return last_news_; }

 private:
  struct Running {
    SessionRecord record;
    std::map<int64_t, msg::Query> queries;
    std::set<int64_t> answered;
    std::optional<Utime> answered_at;  // stamp of the latest answer
  };

  Running* Find(const std::string& session_id, Utime now);
  void End(const std::string& session_id, Utime now);

  const std::string user_;
  const std::function<void(const SessionRecord&)> on_end_;
  std::map<std::string, Running> running_;
  std::set<std::string> began_;
  std::set<std::string> over_;
  int ended_count_ = 0;
  int questions_ = 0;
  Utime last_news_ = 0;
};

}  // namespace beckon::tool
