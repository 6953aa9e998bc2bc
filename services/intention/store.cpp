#include "services/intention/store.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "lcmtypes/codec.h"
#include "services/intention/store_rows.h"
#include "services/intention/store_schema.h"

namespace beckon::intention {
namespace fs = std::filesystem;
namespace {

using Immediate = SQLite::Transaction;
constexpr auto kImmediate = SQLite::TransactionBehavior::IMMEDIATE;

/// More than any learner looks back.
constexpr int kMostSessions = 300;
constexpr int kMostLabels = 500;

/// What SQLite would say less clearly, or only with the first write.
Status CheckPlace(const std::string& path, Store::Mode mode) {
  std::error_code failed;
  if (fs::is_directory(path, failed))
    return Error{path + ": is a folder, expected a database file"};
  const bool exists = fs::exists(path, failed);
  if (mode == Store::Mode::kRead) {
    if (!exists) return Error{path + ": no such database; check --db"};
    if (access(path.c_str(), R_OK) != 0)
      return Error{path + ": cannot read the database; check its permissions"};
    return {};
  }
  fs::path folder = fs::path(path).parent_path();
  if (folder.empty()) folder = ".";
  fs::create_directories(folder, failed);
  if (!fs::is_directory(folder)) {
    return Error{path + ": cannot make the folder " + folder.string() + "; use another --db"};
  }
  if (access(folder.c_str(), W_OK) != 0) {
    return Error{path + ": the folder is read-only; make it writable, or use another --db"};
  }
  if (exists && access(path.c_str(), W_OK) != 0) {
    return Error{path + ": the database is read-only; make it writable, or use another --db"};
  }
  return {};
}

Status CheckSound(SQLite::Database& database, const std::string& path) {
  const std::string found = database.execAndGet("PRAGMA quick_check(1)").getString();
  if (found == "ok") return {};
  return Error{path + ": the database is damaged (" + found.substr(0, found.find('\n')) +
               "); put it aside and import a backup (beckon-intention import)"};
}

std::unique_ptr<SQLite::Database> OpenToRead(const std::string& path) {
  // A file in a folder where SQLite cannot make its shared memory can still be read when nobody
  // writes it.
  const bool quiet =
      !fs::exists(path + "-wal") && access(fs::absolute(path).parent_path().c_str(), W_OK) != 0;
  const std::string uri = "file:" + fs::absolute(path).string() + (quiet ? "?immutable=1" : "");
  return std::make_unique<SQLite::Database>(uri, SQLite::OPEN_READONLY | SQLite::OPEN_URI,
                                            Store::kBusyMs);
}

std::unique_ptr<SQLite::Database> OpenToWrite(const std::string& path) {
  auto database = std::make_unique<SQLite::Database>(
      path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, Store::kBusyMs);
  return database;
}

Status Prepare(SQLite::Database& database, const std::string& path) {
  if (Status known = CheckVersion(database, path); !known) return known;
  if (Status sound = CheckSound(database, path); !sound) return sound;
  const std::string mode = database.execAndGet("PRAGMA journal_mode = WAL").getString();
  if (mode != "wal")
    return Error{path + ": the file system does not support SQLite's WAL; use another --db"};
  database.exec("PRAGMA synchronous = FULL");
  return Migrate(database, path);
}

}  // namespace

Store::Store(std::string path, std::string machine, std::unique_ptr<SQLite::Database> database)
    : path_(std::move(path)), machine_(std::move(machine)), database_(std::move(database)) {}
Store::~Store() = default;

Result<std::unique_ptr<Store>> Store::Open(const std::string& path, const std::string& machine,
                                           Mode mode) {
  if (Status place = CheckPlace(path, mode); !place) return place.error();
  try {
    auto database = mode == Mode::kRead ? OpenToRead(path) : OpenToWrite(path);
    if (mode == Mode::kWrite) {
      if (Status ready = Prepare(*database, path); !ready) return ready.error();
    } else {
      if (Status known = CheckVersion(*database, path); !known) return known.error();
      if (database->execAndGet("PRAGMA user_version").getInt() < kSchemaVersion) {
        return Error{path + ": is of an older version; start beckon-intention on it once"};
      }
      if (Status sound = CheckSound(*database, path); !sound) return sound.error();
    }
    return std::unique_ptr<Store>(new Store(path, machine, std::move(database)));
  } catch (const SQLite::Exception& e) {
    return Explain(e, path);
  }
}

template <typename T, typename Work>
Result<T> Store::Try(Work work) {
  try {
    return work();
  } catch (const SQLite::Exception& e) {
    return Explain(e, path_);
  }
}

// ---- Reading
// --------------------------------------------------------------------------------------

Result<std::vector<SessionRecord>> Store::SessionsOf(const std::string& user) {
  return Try<std::vector<SessionRecord>>([&]() -> Result<std::vector<SessionRecord>> {
    SQLite::Statement query(
        *database_,
        "SELECT body FROM (SELECT body, utime, origin, seq FROM sessions WHERE user = ? "
        "ORDER BY utime DESC, origin DESC, seq DESC LIMIT ?) ORDER BY utime, origin, seq");
    query.bind(1, user);
    query.bind(2, kMostSessions);
    std::vector<SessionRecord> sessions;
    while (query.executeStep()) {
      auto session = SessionFromBody(query.getColumn(0).getString());
      if (!session) return Error{path_ + ": a session cannot be read: " + session.error().message};
      sessions.push_back(*std::move(session));
    }
    return sessions;
  });
}

Result<std::vector<SessionRecord>> Store::AllSessions() {
  return Try<std::vector<SessionRecord>>([&]() -> Result<std::vector<SessionRecord>> {
    SQLite::Statement query(*database_, "SELECT body FROM sessions ORDER BY utime, origin, seq");
    std::vector<SessionRecord> sessions;
    while (query.executeStep()) {
      auto session = SessionFromBody(query.getColumn(0).getString());
      if (!session) return Error{path_ + ": a session cannot be read: " + session.error().message};
      sessions.push_back(*std::move(session));
    }
    return sessions;
  });
}

Result<std::vector<LabelRecord>> Store::LabelsOf(const std::string& source) {
  return Try<std::vector<LabelRecord>>([&]() -> Result<std::vector<LabelRecord>> {
    SQLite::Statement query(
        *database_,
        "SELECT body FROM (SELECT body, utime, origin, seq FROM labels WHERE source = ? "
        "ORDER BY utime DESC, origin DESC, seq DESC LIMIT ?) ORDER BY utime, origin, seq");
    query.bind(1, source);
    query.bind(2, kMostLabels);
    std::vector<LabelRecord> labels;
    while (query.executeStep()) {
      auto label = LabelFromBody(query.getColumn(0).getString());
      if (!label) return Error{path_ + ": a label cannot be read: " + label.error().message};
      labels.push_back(*std::move(label));
    }
    return labels;
  });
}

Result<std::optional<SessionRecord>> Store::FindSession(const std::string& session_id) {
  return Try<std::optional<SessionRecord>>([&]() -> Result<std::optional<SessionRecord>> {
    SQLite::Statement query(*database_, "SELECT body FROM rows WHERE uid = ?");
    query.bind(1, "session/" + session_id);
    if (!query.executeStep()) return std::optional<SessionRecord>();
    auto session = SessionFromBody(query.getColumn(0).getString());
    if (!session) return Error{path_ + ": a session cannot be read: " + session.error().message};
    return std::optional(*std::move(session));
  });
}

Result<std::vector<msg::Task>> Store::OpenTasks() {
  return Try<std::vector<msg::Task>>([&]() -> Result<std::vector<msg::Task>> {
    SQLite::Statement query(
        *database_,
        "SELECT encoded FROM tasks WHERE task_id NOT IN (SELECT task_id FROM task_states)");
    std::vector<msg::Task> tasks;
    while (query.executeStep()) {
      const SQLite::Column blob = query.getColumn(0);
      const auto* bytes = static_cast<const uint8_t*>(blob.getBlob());
      auto task = Codec<msg::Task>::Decode({bytes, static_cast<size_t>(blob.getBytes())});
      if (!task) return Error{path_ + ": a task cannot be read: " + task.error().message};
      tasks.push_back(*std::move(task));
    }
    return tasks;
  });
}

Result<bool> Store::Stopped() {
  return Try<bool>([&]() -> Result<bool> {
    SQLite::Statement query(*database_, "SELECT stopped FROM stops ORDER BY rowid DESC LIMIT 1");
    return query.executeStep() && query.getColumn(0).getInt() != 0;
  });
}

Result<int64_t> Store::RowCount() {
  return Try<int64_t>([&]() -> Result<int64_t> {
    return database_->execAndGet("SELECT COALESCE(MAX(rowid), 0) FROM rows").getInt64();
  });
}

Result<std::vector<HistoryRow>> Store::Rows() {
  return Try<std::vector<HistoryRow>>([&]() -> Result<std::vector<HistoryRow>> {
    SQLite::Statement query(*database_,
                            "SELECT origin, seq, kind, body FROM rows ORDER BY origin, seq");
    std::vector<HistoryRow> rows;
    while (query.executeStep()) {
      rows.push_back({query.getColumn(0).getString(), query.getColumn(1).getInt64(),
                      query.getColumn(2).getString(), query.getColumn(3).getString()});
    }
    return rows;
  });
}

// ---- Writing
// --------------------------------------------------------------------------------------

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
