#include "tools/beckon/log_index.h"

#include <algorithm>
#include <charconv>

#include "lcmtypes/codec.h"
#include "tools/beckon/task_words.h"

namespace beckon::tool {
namespace {

void Extend(LoggedSession& session, const LoggedMessage& message) {
  session.end = message.utime;
  session.end_offset = message.end;
}

}  // namespace

const LoggedSession* LogIndex::Find(const std::string& name) const {
  int number = 0;
  const auto [last, failed] = std::from_chars(name.data(), name.data() + name.size(), number);
  const bool is_number = failed == std::errc{} && last == name.data() + name.size();
  const LoggedSession* found = nullptr;
  for (const auto& session : sessions) {
    if (session.id == name || (is_number && session.number == number)) return &session;
    if (name.empty() || !session.id.starts_with(name)) continue;
    if (found != nullptr) return nullptr;
    found = &session;
  }
  return found;
}

void LogIndexer::Add(const LoggedMessage& message) {
  if (index_.messages++ == 0) index_.begin = message.utime;
  index_.end = std::max(index_.end, message.utime);
  index_.bytes = message.end;
  LoggedChannel& channel = index_.channels[message.channel];
  ++channel.messages;
  channel.bytes += static_cast<int64_t>(message.data.size());
  if (const auto session = Decode<msg::Session>(message)) OnSession(*session, message);
  if (const auto query = Decode<msg::Query>(message)) OnQuery(*query, message);
  if (const auto task = Decode<msg::Task>(message)) OnTask(*task, message);
  if (const auto status = Decode<msg::TaskStatus>(message)) OnTaskStatus(*status, message);
  if (const auto status = Decode<msg::Status>(message)) OnStatus(*status, message);
}

template <typename T>
std::optional<T> LogIndexer::Decode(const LoggedMessage& message) {
  if (message.channel != Codec<T>::kChannel) return std::nullopt;
  auto decoded = Codec<T>::Decode(message.data);
  if (decoded) return *std::move(decoded);
  ++index_.refused;
  return std::nullopt;
}

LoggedSession* LogIndexer::Known(const std::string& id) {
  const auto found = following_.find(id);
  return found == following_.end() ? nullptr : &index_.sessions[found->second.place];
}

LoggedSession& LogIndexer::Touch(const std::string& id, const std::string& user,
                                 const LoggedMessage& message) {
  const auto [entry, made] = following_.try_emplace(id, Following{index_.sessions.size(), {}});
  if (made) {
    LoggedSession session;
    session.number = static_cast<int>(index_.sessions.size()) + 1;
    session.id = id;
    session.user = user;
    session.begin = message.utime;
    session.offset = message.offset;
    session.outcome = "running";
    index_.sessions.push_back(std::move(session));
  }
  LoggedSession& session = index_.sessions[entry->second.place];
  // What is repeated after the end is no more of it.
  if (!entry->second.over) Extend(session, message);
  return session;
}

void LogIndexer::End(LoggedSession& session, const char* outcome, const std::string& detail,
                     const LoggedMessage& message) {
  Following& following = following_.at(session.id);
  if (following.over) return;
  following.over = true;
  session.outcome = outcome;
  session.detail = detail;
  Extend(session, message);
}

void LogIndexer::OnSession(const msg::Session& session, const LoggedMessage& message) {
  using enum msg::SessionKind;
  if (session.kind == kStopped || session.kind == kRequestStop) {
    for (auto& running : index_.sessions) End(running, "stopped", "", message);
    return;
  }
  if (session.session_id.empty() || session.kind == kIdle) return;
  if (session.kind == kRequestStart || session.kind == kBegun)
    Touch(session.session_id, session.user, message);
  LoggedSession* known = Known(session.session_id);
  if (known == nullptr) return;
  if (session.kind == kConfirmed) End(*known, "confirmed", "", message);
  if (session.kind == kAbandoned) End(*known, "abandoned", session.text, message);
}

void LogIndexer::OnQuery(const msg::Query& query, const LoggedMessage& message) {
  LoggedSession& session = Touch(query.session_id, query.user, message);
  Following& following = following_.at(query.session_id);
  if (following.over) return;
  following.queries.insert(query.id);
  session.questions = static_cast<int>(following.queries.size());
}

void LogIndexer::OnTask(const msg::Task& task, const LoggedMessage& message) {
  LoggedSession& session = Touch(task.task_id, task.user, message);
  if (!session.task.empty()) return;  // repeated
  session.task = TaskWords(task);
  End(session, "confirmed", "", message);
  Extend(session, message);
}

void LogIndexer::OnTaskStatus(const msg::TaskStatus& status, const LoggedMessage& message) {
  LoggedSession* session = Known(status.task_id);
  if (session == nullptr) return;
  const char* words = Name(status.state);
  if (session->detail == words || session->detail == "done") return;  // repeated
  session->detail = words;
  Extend(*session, message);
}

void LogIndexer::OnStatus(const msg::Status& status, const LoggedMessage& message) {
  auto [entry, made] = index_.processes.try_emplace({status.host, status.service, status.pid});
  LoggedProcess& process = entry->second;
  if (made) process.first = message.utime;
  process.build = status.build;
  process.last = message.utime;
}

}  // namespace beckon::tool
