// What `beckon top` knows of the conversations: who is asked what, what came of it. Pure.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/messages.h"

namespace beckon::tool {

struct TopTalk {
  std::string user;
  std::string state;  // "asked", "waiting", "over"
  std::string text;   // the question; what is waited for; how it ended
  std::string kind;   // of the question
  int questions = 0;  // answers given so far
  Utime since_us = 0;
  bool silent = false;  // nothing was heard of it of late
};

struct TopTask {
  std::string user;
  std::string task;   // "Open Carton 1"
  std::string state;  // "published", or what the robot said last
  Utime since_us = 0;
};

struct TopTalks {
  std::vector<TopTalk> talks;  // by user
  std::optional<TopTask> last_task;
  bool stopped = false;
};

class TopConversations {
 public:
  /// What intention repeats is repeated every second at least.
  static constexpr Utime kSilent_us = 5 * kSecond;

  /// `now`: of a clock that only counts up.
  void OnSession(const msg::Session& session, Utime now);
  void OnQuery(const msg::Query& query, Utime now);
  void OnTask(const msg::Task& task, Utime now);
  void OnTaskStatus(const msg::TaskStatus& status, Utime now);

  TopTalks View(Utime now) const;

 private:
  struct Talk {
    std::string session_id;
    TopTalk view;
    int64_t query_id = 0;
    Utime since = 0;
    Utime heard = 0;
  };

  Talk* Find(const std::string& user);
  void Tell(Talk& talk, const std::string& state, const std::string& text, Utime now);

  std::map<std::string, Talk> talks_;  // by user
  std::optional<msg::Task> task_;
  std::string task_state_;
  Utime task_since_ = 0;
  bool stopped_ = false;
};

}  // namespace beckon::tool
