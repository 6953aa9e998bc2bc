#include "tools/beckon/session_observer.h"

#include <algorithm>
#include <utility>

namespace beckon::tool {

int SessionRecord::CategoryQuestions() const {
  return static_cast<int>(
      std::ranges::count(answers, msg::QueryKind::kWhatIsIt, &GivenAnswer::kind));
}

SessionObserver::SessionObserver(std::string user, std::function<void(const SessionRecord&)> on_end)
    : user_(std::move(user)), on_end_(std::move(on_end)) {}

SessionObserver::Running* SessionObserver::Find(const std::string& session_id, Utime now) {
  if (session_id.empty() || over_.contains(session_id)) return nullptr;
  auto [entry, made] = running_.try_emplace(session_id);
  if (made) {
    entry->second.record.session_id = session_id;
    entry->second.record.requested = now;
    last_news_ = now;
  }
  return &entry->second;
}

void SessionObserver::OnSession(const msg::Session& message, Utime now) {
  if (message.user != user_) return;
  switch (message.kind) {
    case msg::SessionKind::kRequestStart:
      Find(message.session_id, now);
      break;
    case msg::SessionKind::kBegun:
      if (Find(message.session_id, now) != nullptr && began_.insert(message.session_id).second)
        last_news_ = now;
      break;
    case msg::SessionKind::kAbandoned:
      if (auto* running = Find(message.session_id, now)) {
        running->record.outcome = message.text.empty() ? "given up" : message.text;
        End(message.session_id, now);
      }
      break;
    default:
      break;
  }
}

void SessionObserver::OnQuery(const msg::Query& query, Utime now) {
  if (query.user != user_) return;
  auto* running = Find(query.session_id, now);
  if (running == nullptr || !running->queries.emplace(query.id, query).second) return;
  ++questions_;
  last_news_ = now;
  if (!running->record.first_query) running->record.first_query = now;
  if (const auto since = std::exchange(running->answered_at, std::nullopt);
      since && query.utime >= *since) {
    running->record.answer_to_query_ms.push_back(static_cast<double>(query.utime - *since) * 1e-3);
  }
}

void SessionObserver::OnAnswer(const msg::Answer& answer, Utime now) {
  const auto found = running_.find(answer.session_id);
  if (found == running_.end()) return;
  auto& running = found->second;
  const auto query = running.queries.find(answer.query_id);
  if (query == running.queries.end() || answer.likelihoods.size() != query->second.options.size())
    return;
  if (!running.answered.insert(answer.query_id).second) return;
  last_news_ = now;
  running.answered_at = answer.utime;
  const auto likeliest = std::ranges::max_element(answer.likelihoods) - answer.likelihoods.begin();
  const msg::Query& asked = query->second;
  const bool what_is_it = asked.kind == msg::QueryKind::kWhatIsIt && !asked.objects.empty();
  running.record.answers.push_back({answer.query_id, asked.kind, asked.text,
                                    asked.options[static_cast<size_t>(likeliest)].text,
                                    what_is_it ? asked.objects.front().object_id : 0});
}

void SessionObserver::OnTask(const msg::Task& task, Utime now) {
  if (task.user != user_) return;
  if (auto* running = Find(task.task_id, now)) {
    running->record.task = task;
    End(task.task_id, now);
  }
}

void SessionObserver::End(const std::string& session_id, Utime now) {
  auto entry = running_.extract(session_id);
  over_.insert(session_id);
  SessionRecord& record = entry.mapped().record;
  record.ended = now;
  record.number = ++ended_count_;
  last_news_ = now;
  on_end_(record);
}

}  // namespace beckon::tool
