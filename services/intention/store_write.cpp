// What the store writes; every call is one transaction.
#include <SQLiteCpp/SQLiteCpp.h>

#include <nlohmann/json.hpp>

#include "lcmtypes/codec.h"
#include "services/intention/store.h"
#include "services/intention/store_rows.h"
#include "services/intention/store_try.h"

namespace beckon::intention {
namespace {

using Immediate = SQLite::Transaction;
constexpr auto kImmediate = SQLite::TransactionBehavior::IMMEDIATE;

}  // namespace

bool Store::Has(const std::string& uid) {
  SQLite::Statement query(*database_, "SELECT 1 FROM rows WHERE uid = ?");
  query.bind(1, uid);
  return query.executeStep();
}

int64_t Store::NextSeq() {
  SQLite::Statement query(*database_,
                          "SELECT COALESCE(MAX(seq), 0) + 1 FROM rows WHERE origin = ?");
  query.bind(1, machine_);
  query.executeStep();
  return query.getColumn(0).getInt64();
}

void Store::InsertRow(const HistoryRow& row, const std::string& uid, const std::string& user,
                      Utime utime) {
  SQLite::Statement insert(
      *database_,
      "INSERT INTO rows (origin, seq, kind, uid, user, utime, body) VALUES (?, ?, ?, ?, ?, ?, ?)");
  insert.bind(1, row.origin);
  insert.bind(2, row.seq);
  insert.bind(3, row.kind);
  insert.bind(4, uid);
  insert.bind(5, user);
  insert.bind(6, utime);
  insert.bind(7, row.body);
  insert.exec();
}

bool Store::Insert(const std::string& kind, const std::string& uid, const std::string& user,
                   Utime utime, const std::string& body) {
  if (Has(uid)) return false;
  InsertRow({machine_, NextSeq(), kind, body}, uid, user, utime);
  return true;
}

Result<bool> Store::Commit(const SessionRecord& session, const std::vector<LabelRecord>& labels,
                           const msg::Task& task) {
  const auto encoded = Codec<msg::Task>::Encode(task);
  if (!encoded) return Error{"the task cannot be stored: " + encoded.error().message};
  return Try<bool>([&]() -> Result<bool> {
    Immediate transaction(*database_, kImmediate);
    if (!Insert("session", "session/" + session.session_id, session.user, session.utime,
                ToBody(session))) {
      return false;
    }
    for (const LabelRecord& label : labels) {
      Insert("label", "label/" + label.id, label.user, label.utime, ToBody(label));
    }
    SQLite::Statement insert(*database_, "INSERT INTO tasks (task_id, encoded) VALUES (?, ?)");
    insert.bind(1, task.task_id);
    insert.bind(2, encoded->data(), static_cast<int>(encoded->size()));
    insert.exec();
    transaction.commit();
    return true;
  });
}

Status Store::CommitLabels(const std::vector<LabelRecord>& labels) {
  if (labels.empty()) return {};
  return Try<void>([&]() -> Status {
    Immediate transaction(*database_, kImmediate);
    for (const LabelRecord& label : labels) {
      Insert("label", "label/" + label.id, label.user, label.utime, ToBody(label));
    }
    transaction.commit();
    return {};
  });
}

Status Store::NoteTask(const std::string& task_id, msg::TaskState state, Utime now) {
  return Try<void>([&]() -> Status {
    SQLite::Statement insert(*database_,
                             "INSERT INTO task_states (task_id, state, utime) VALUES (?, ?, ?)");
    insert.bind(1, task_id);
    insert.bind(2, static_cast<int>(state));
    insert.bind(3, now);
    insert.exec();
    return {};
  });
}

Status Store::SetStopped(bool stopped, Utime now) {
  return Try<void>([&]() -> Status {
    SQLite::Statement insert(*database_, "INSERT INTO stops (utime, stopped) VALUES (?, ?)");
    insert.bind(1, now);
    insert.bind(2, stopped ? 1 : 0);
    insert.exec();
    return {};
  });
}

Result<int> Store::AddRows(const std::vector<HistoryRow>& rows) {
  return Try<int>([&]() -> Result<int> {
    Immediate transaction(*database_, kImmediate);
    int added = 0;
    for (const HistoryRow& row : rows) {
      const std::string name = "row " + std::to_string(row.seq) + " of '" + row.origin + "'";
      if (row.origin.empty() || row.seq < 1 || row.kind.empty())
        return Error{name + ": origin, seq or kind is empty"};
      const auto head = HeadOf(row.origin, row.seq, row.kind, row.body);
      if (!head) return Error{name + ": " + head.error().message};
      SQLite::Statement query(*database_,
                              "SELECT kind, body FROM rows WHERE origin = ? AND seq = ?");
      query.bind(1, row.origin);
      query.bind(2, row.seq);
      if (query.executeStep()) {
        if (query.getColumn(0).getString() == row.kind &&
            query.getColumn(1).getString() == row.body)
          continue;
        return Error{name +
                     ": another row of that number is in the database; two machines share a name"};
      }
      if (Has(head->uid)) continue;
      InsertRow(row, head->uid, head->user, head->utime);
      ++added;
    }
    transaction.commit();
    return added;
  });
}

Result<int> Store::ForgetUser(const std::string& user, Utime now) {
  return Try<int>([&]() -> Result<int> {
    Immediate transaction(*database_, kImmediate);
    SQLite::Statement sessions(*database_, "SELECT COUNT(*) FROM sessions WHERE user = ?");
    sessions.bind(1, user);
    sessions.executeStep();
    const int count = sessions.getColumn(0).getInt();
    nlohmann::ordered_json body = {
        {"user", user}, {"utime", now}, {"covers", nlohmann::ordered_json::object()}};
    SQLite::Statement seqs(*database_,
                           "SELECT origin, MAX(seq) FROM rows WHERE user = ? GROUP BY origin");
    seqs.bind(1, user);
    while (seqs.executeStep())
      body["covers"][seqs.getColumn(0).getString()] = seqs.getColumn(1).getInt64();
    if (body["covers"].empty()) return Error{path_ + ": knows nothing of user '" + user + "'"};
    Insert("forget", "forget/" + machine_ + "/" + std::to_string(NextSeq()), user, now,
           body.dump());
    transaction.commit();
    return count;
  });
}

Result<SessionRecord> Store::ForgetLast(const std::string& user, Utime now) {
  return Try<SessionRecord>([&]() -> Result<SessionRecord> {
    Immediate transaction(*database_, kImmediate);
    SQLite::Statement query(*database_,
                            "SELECT body FROM sessions WHERE ?1 = '' OR user = ?1 "
                            "ORDER BY utime DESC, origin DESC, seq DESC LIMIT 1");
    query.bind(1, user);
    if (!query.executeStep()) return Error{path_ + ": there is no session to forget"};
    const auto session = SessionFromBody(query.getColumn(0).getString());
    if (!session) return session.error();
    const nlohmann::ordered_json body = {{"session_id", session->session_id}, {"utime", now}};
    Insert("forget", "forget/" + machine_ + "/" + std::to_string(NextSeq()), session->user, now,
           body.dump());
    transaction.commit();
    return *session;
  });
}

}  // namespace beckon::intention
