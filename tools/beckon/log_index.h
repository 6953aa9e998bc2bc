// What is in a log of the bus: its conversations, the processes it heard, its channels. Pure:
// messages in, index out.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "lcmtypes/messages.h"
#include "tools/beckon/log_reader.h"

namespace beckon::tool {

/// A conversation, from its first request to its outcome, the robot's answer included.
struct LoggedSession {
  int number = 0;  // from 1, in the order of their begin
  std::string id;
  std::string user;
  Utime begin = 0;  // as the logger heard it
  Utime end = 0;    // of the latest message that belongs to it
  int64_t offset = 0;
  int64_t end_offset = 0;
  int questions = 0;    // different ones
  std::string outcome;  // "running", "confirmed", "abandoned", "stopped"
  std::string task;     // of a confirmed one, e.g. "Open Carton 1"
  std::string detail;   // why it was abandoned; what the robot said last of the task
};

struct LoggedChannel {
  int64_t messages = 0;
  int64_t bytes = 0;
};

/// By host, service and process id.
struct LoggedProcess {
  std::string build;
  Utime first = 0;
  Utime last = 0;
};

struct LogIndex {
  Utime begin = 0;
  Utime end = 0;
  int64_t messages = 0;
  int64_t bytes = 0;    // of the log, up to where it was read
  int64_t refused = 0;  // messages that this version cannot read
  std::map<std::string, LoggedChannel> channels;
  std::map<std::tuple<std::string, std::string, int>, LoggedProcess> processes;
  std::vector<LoggedSession> sessions;  // by begin

  /// By number, by id, or by the beginning of an id that no other has.
  const LoggedSession* Find(const std::string& name) const;
};

class LogIndexer {
 public:
  void Add(const LoggedMessage& message);
  const LogIndex& index() const { return index_; }

 private:
  struct Following {
    size_t place;  // in index_.sessions
    std::set<int64_t> queries;
    bool over = false;
  };

  template <typename T>
  std::optional<T> Decode(const LoggedMessage& message);
  /// The session of this id, made where it is new.
  LoggedSession& Touch(const std::string& id, const std::string& user,
                       const LoggedMessage& message);
  LoggedSession* Known(const std::string& id);
  void End(LoggedSession& session, const char* outcome, const std::string& detail,
           const LoggedMessage& message);
  void OnSession(const msg::Session& session, const LoggedMessage& message);
  void OnQuery(const msg::Query& query, const LoggedMessage& message);
  void OnTask(const msg::Task& task, const LoggedMessage& message);
  void OnTaskStatus(const msg::TaskStatus& status, const LoggedMessage& message);
  void OnStatus(const msg::Status& status, const LoggedMessage& message);

  LogIndex index_;
  std::map<std::string, Following> following_;  // by session id
};

}  // namespace beckon::tool
