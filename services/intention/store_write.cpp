// What the store writes of its own; every call is one transaction.
#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>

#include "lcmtypes/codec.h"
#include "services/intention/store.h"
#include "services/intention/store_rows.h"
#include "services/intention/store_try.h"

namespace beckon::intention {
namespace {

using Immediate = SQLite::Transaction;

/// Without its first answers where it is too long for a message: they tell the least of how a
/// device errs now.
std::string BoundedBody(SessionRecord session) {
  std::string body = ToBody(session);
  while (body.size() > Store::kMostBody && !session.answers.empty()) {
    session.answers.erase(
        session.answers.begin(),
        session.answers.begin() + static_cast<std::ptrdiff_t>(session.answers.size() + 3) / 4);
    body = ToBody(session);
  }
  return body;
}

}  // namespace

SQLite::Statement& Store::Prepared(const char* sql) {
  auto& statement = prepared_[sql];
  if (!statement) statement = std::make_unique<SQLite::Statement>(*database_, sql);
  statement->reset();
  statement->clearBindings();
  return *statement;
}

bool Store::Has(const std::string& uid) {
  auto& query = Prepared("SELECT 1 FROM rows WHERE uid = ?");
  query.bind(1, uid);
  const bool found = query.executeStep();
  query.reset();
  return found;
}

int64_t Store::NextSeq(const std::string& origin) {
  auto& query = Prepared("SELECT COALESCE(MAX(seq), 0) + 1 FROM rows WHERE origin = ?");
  query.bind(1, origin);
  query.executeStep();
  const int64_t seq = query.getColumn(0).getInt64();
  query.reset();
  return seq;
}

/// No clock is trusted more than a day ahead: its rows are kept, but must not drag everybody's
/// time along.
Utime Store::HybridTime(Utime now) {
  auto& query = Prepared("SELECT COALESCE(MAX(hybrid_utime), 0) FROM rows WHERE hybrid_utime <= ?");
  query.bind(1, now == 0 ? INT64_MAX : now + kMostAhead);
  query.executeStep();
  const Utime known = query.getColumn(0).getInt64();
  query.reset();
  return std::max(now, known + 1);
}

void Store::InsertRow(const HistoryRow& row, const RowHead& head) {
  auto& insert = Prepared(
      "INSERT INTO rows (origin, seq, kind, uid, user, utime, hybrid_utime, hash, body) "
      "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)");
  insert.bind(1, row.origin);
  insert.bind(2, row.seq);
  insert.bind(3, row.kind);
  insert.bind(4, head.uid);
  insert.bind(5, head.user);
  insert.bind(6, head.utime);
  insert.bind(7, row.hybrid_utime);
  insert.bind(8, static_cast<int64_t>(head.hash));
  insert.bind(9, row.body);
  insert.exec();
  insert.reset();
}

bool Store::Insert(const std::string& kind, const RowHead& head, const std::string& body,
                   Utime now) {
  if (Has(head.uid)) return false;
  const HistoryRow row{origin_, NextSeq(origin_), kind, body, HybridTime(now)};
  RowHead hashed = head;
  hashed.hash = RowHash(row);
  InsertRow(row, hashed);
  return true;
}

Result<bool> Store::Commit(const SessionRecord& session, const std::vector<LabelRecord>& labels,
                           const msg::Task& task) {
  const auto encoded = Codec<msg::Task>::Encode(task);
  if (!encoded) return Error{"the task cannot be stored: " + encoded.error().message};
  return Try<bool>([&]() -> Result<bool> {
    Immediate transaction(*database_, kImmediate);
    if (!Insert("session", {"session/" + session.session_id, session.user, session.utime},
                BoundedBody(session), session.utime)) {
      return false;
    }
    for (const LabelRecord& label : labels) {
      Insert("label", {"label/" + label.id, label.user, label.utime}, ToBody(label), label.utime);
    }
    auto& insert = Prepared("INSERT INTO tasks (task_id, encoded) VALUES (?, ?)");
    insert.bind(1, task.task_id);
    insert.bind(2, encoded->data(), static_cast<int>(encoded->size()));
    insert.exec();
    insert.reset();
    transaction.commit();
    Advance(origin_);
    return true;
  });
}

Status Store::CommitLabels(const std::vector<LabelRecord>& labels) {
  if (labels.empty()) return {};
  return Try<void>([&]() -> Status {
    Immediate transaction(*database_, kImmediate);
    for (const LabelRecord& label : labels) {
      Insert("label", {"label/" + label.id, label.user, label.utime}, ToBody(label), label.utime);
    }
    transaction.commit();
    Advance(origin_);
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

}  // namespace beckon::intention
