#include "services/intention/store.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <unistd.h>

#include <filesystem>

#include "lcmtypes/codec.h"
#include "services/intention/store_rows.h"
#include "services/intention/store_schema.h"
#include "services/intention/store_try.h"

namespace beckon::intention {
namespace fs = std::filesystem;
namespace {

/// More than any learner looks back.
constexpr int kMostSessions = 1000;
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
  database.exec("PRAGMA secure_delete = ON");  // what is forgotten does not stay in free pages
  return Migrate(database, path);
}

/// The records in the first column of every row; `what` names one in an error.
template <typename Record>
Result<std::vector<Record>> ReadAll(SQLite::Statement& query,
                                    Result<Record> (*parse)(const std::string&),
                                    const std::string& what) {
  std::vector<Record> records;
  while (query.executeStep()) {
    auto record = parse(query.getColumn(0).getString());
    if (!record) return Error{what + " cannot be read: " + record.error().message};
    records.push_back(*std::move(record));
  }
  return records;
}

}  // namespace

Store::Store(std::string path, std::string machine, std::unique_ptr<SQLite::Database> database)
    : path_(std::move(path)),
      machine_(std::move(machine)),
      database_(std::move(database)),
      origin_(machine_) {}
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
    std::unique_ptr<Store> store(new Store(path, machine, std::move(database)));
    if (mode == Mode::kWrite) store->ReadIdentity();
    return store;
  } catch (const SQLite::Exception& e) {
    return Explain(e, path);
  }
}

Result<std::vector<SessionRecord>> Store::SessionsOf(const std::string& user) {
  return Try<std::vector<SessionRecord>>([&]() -> Result<std::vector<SessionRecord>> {
    SQLite::Statement query(
        *database_,
        "SELECT body FROM (SELECT body, hybrid_utime, origin, seq FROM sessions WHERE user = ? "
        "ORDER BY hybrid_utime DESC, origin DESC, seq DESC LIMIT ?) "
        "ORDER BY hybrid_utime, origin, seq");
    query.bind(1, user);
    query.bind(2, kMostSessions);
    return ReadAll(query, SessionFromBody, path_ + ": a session");
  });
}

Result<std::vector<SessionRecord>> Store::AllSessions() {
  return Try<std::vector<SessionRecord>>([&]() -> Result<std::vector<SessionRecord>> {
    SQLite::Statement query(*database_,
                            "SELECT body FROM sessions ORDER BY hybrid_utime, origin, seq");
    return ReadAll(query, SessionFromBody, path_ + ": a session");
  });
}

Result<std::vector<std::string>> Store::Users() {
  return Try<std::vector<std::string>>([&]() -> Result<std::vector<std::string>> {
    SQLite::Statement query(
        *database_,

        "SELECT user FROM sessions GROUP BY user ORDER BY MAX(hybrid_utime) DESC");
    std::vector<std::string> users;
    while (query.executeStep()) users.push_back(query.getColumn(0).getString());
    return users;
  });
}

Result<std::vector<LabelRecord>> Store::LabelsOf(const std::string& source) {
  return Try<std::vector<LabelRecord>>([&]() -> Result<std::vector<LabelRecord>> {
    SQLite::Statement query(
        *database_,
        "SELECT body FROM (SELECT body, hybrid_utime, origin, seq FROM labels WHERE source = ? "
        "ORDER BY hybrid_utime DESC, origin DESC, seq DESC LIMIT ?) "
        "ORDER BY hybrid_utime, origin, seq");
    query.bind(1, source);
    query.bind(2, kMostLabels);
    return ReadAll(query, LabelFromBody, path_ + ": a label");
  });
}

Result<std::optional<SessionRecord>> Store::FindSession(const std::string& session_id) {
  return Try<std::optional<SessionRecord>>([&]() -> Result<std::optional<SessionRecord>> {
    SQLite::Statement query(*database_,
                            "SELECT body, kind FROM rows WHERE uid = ? "
                            "ORDER BY kind <> 'session', hybrid_utime, origin, seq LIMIT 1");
    query.bind(1, "session/" + session_id);
    if (!query.executeStep()) return std::optional<SessionRecord>();
    if (query.getColumn(1).getString() == kErased) {
      SessionRecord forgotten;
      forgotten.session_id = session_id;
      return std::optional(forgotten);
    }
    auto session = SessionFromBody(query.getColumn(0).getString());
    if (!session) return Error{path_ + ": a session cannot be read: " + session.error().message};
    return std::optional(*std::move(session));
  });
}

Result<std::vector<msg::Task>> Store::OpenTasks() {
  return Try<std::vector<msg::Task>>([&]() -> Result<std::vector<msg::Task>> {
    SQLite::Statement query(*database_,
                            "SELECT encoded FROM tasks WHERE encoded <> x'' "
                            "AND task_id NOT IN (SELECT task_id FROM task_states)");
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
    SQLite::Statement query(
        *database_, "SELECT origin, seq, kind, body, hybrid_utime FROM rows ORDER BY origin, seq");
    std::vector<HistoryRow> rows;
    while (query.executeStep()) rows.push_back(RowFrom(query));
    return rows;
  });
}

Result<std::vector<OriginSummary>> Store::Origins() {
  return Try<std::vector<OriginSummary>>([&]() -> Result<std::vector<OriginSummary>> {
    SQLite::Statement query(
        *database_,
        "SELECT origin, COUNT(*), (SELECT COUNT(*) FROM sessions s WHERE s.origin = rows.origin), "
        "SUM(kind = 'erased'), MAX(hybrid_utime) FROM rows GROUP BY origin ORDER BY origin");
    std::vector<OriginSummary> origins;
    while (query.executeStep()) {
      origins.push_back({query.getColumn(0).getString(), query.getColumn(1).getInt64(),
                         query.getColumn(2).getInt64(), query.getColumn(3).getInt64(),
                         query.getColumn(4).getInt64()});
    }
    return origins;
  });
}

}  // namespace beckon::intention
