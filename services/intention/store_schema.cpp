#include "services/intention/store_schema.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <array>

namespace beckon::intention {
namespace {

/// Each entry leads from version i to i + 1. Never edit an entry that was released: add one.
const std::array<const char*, kSchemaVersion> kSteps = {
    // 1: the append-only history, as it is shared between machines; and this machine's tasks.
    R"sql(
      CREATE TABLE rows (
        origin TEXT NOT NULL CHECK (origin <> ''),
        seq INTEGER NOT NULL CHECK (seq >= 1),
        kind TEXT NOT NULL,              -- session, label, forget, ...
        uid TEXT NOT NULL UNIQUE,        -- e.g. session/<session id>
        user TEXT NOT NULL,
        utime INTEGER NOT NULL,          -- us since the epoch
        body TEXT NOT NULL CHECK (json_valid(body)),
        PRIMARY KEY (origin, seq)
      );
      CREATE INDEX rows_by_user ON rows (kind, user, utime);
      CREATE TRIGGER rows_are_never_changed BEFORE UPDATE ON rows
        BEGIN SELECT RAISE(ABORT, 'the history is append-only'); END;
      CREATE TRIGGER rows_are_never_deleted BEFORE DELETE ON rows
        BEGIN SELECT RAISE(ABORT, 'the history is append-only'); END;
      CREATE TABLE tasks (
        task_id TEXT PRIMARY KEY,
        encoded BLOB NOT NULL            -- beckon.task_t, unsealed
      );
      CREATE TABLE task_states (
        task_id TEXT NOT NULL,
        state INTEGER NOT NULL,          -- of task_status_t
        utime INTEGER NOT NULL
      );
      CREATE INDEX task_states_by_task ON task_states (task_id);
    )sql",
    // 2: the stopped state outlives the process; counts as views.
    R"sql(
      CREATE TABLE stops (
        utime INTEGER NOT NULL,
        stopped INTEGER NOT NULL CHECK (stopped IN (0, 1))
      );
      CREATE VIEW forgets AS
        SELECT json_extract(body, '$.session_id') AS session_id, json_extract(body, '$.user') AS user,
          json_extract(body, '$.covers') AS covers
        FROM rows WHERE kind = 'forget';
      CREATE VIEW sessions AS
        SELECT origin, seq, user, utime, body,
          substr(uid, length('session/') + 1) AS session_id,
          json_extract(body, '$.category') AS category,
          json_extract(body, '$.action') AS action,
          json_extract(body, '$.instance') AS instance,
          json_extract(body, '$.questions') AS questions,
          json_extract(body, '$.device') AS device
        FROM rows r WHERE kind = 'session'
          AND NOT EXISTS (SELECT 1 FROM forgets f WHERE r.uid = 'session/' || f.session_id)
          AND NOT EXISTS (SELECT 1 FROM forgets f, json_each(f.covers) c
            WHERE f.user = r.user AND c.key = r.origin AND c.value >= r.seq);
      CREATE VIEW labels AS
        SELECT origin, seq, user, utime, body,
          json_extract(body, '$.session_id') AS session_id,
          json_extract(body, '$.category') AS category,
          json_extract(body, '$.source') AS source
        FROM rows r WHERE kind = 'label'
          AND NOT EXISTS (SELECT 1 FROM forgets f WHERE json_extract(r.body, '$.session_id') = f.session_id)
          AND NOT EXISTS (SELECT 1 FROM forgets f, json_each(f.covers) c
            WHERE f.user = r.user AND c.key = r.origin AND c.value >= r.seq);
      CREATE VIEW counts AS
        SELECT user, category, action, COUNT(*) AS n, SUM(questions) AS questions, MAX(utime) AS last_utime
        FROM sessions GROUP BY user, category, action;
    )sql",
    // 3: counts by instance; answers of both forms (until then: yes, no, meant_yes, and the
    // session's device) and how often each device was wrong; nothing is ever changed.
    R"sql(
      DROP VIEW counts;
      CREATE VIEW counts AS
        SELECT user, category, action, instance, COUNT(*) AS n, SUM(questions) AS questions,
          MAX(utime) AS last_utime
        FROM sessions GROUP BY user, category, action, instance;
      CREATE VIEW answers AS
        SELECT user, session_id, utime, position, device, kind, n_answers, meant,
          CASE WHEN likelihoods IS NULL THEN NOT first_is_likelier
            WHEN n_likeliest = 1 THEN likeliest ELSE n_answers - 1 END AS said
        FROM (
          SELECT s.user, s.session_id, s.utime, a.key AS position,
            COALESCE(json_extract(a.value, '$.device'), s.device) AS device,
            json_extract(a.value, '$.kind') AS kind,
            COALESCE(json_array_length(a.value, '$.likelihoods'), 2) AS n_answers,
            COALESCE(json_extract(a.value, '$.meant'), NOT json_extract(a.value, '$.meant_yes')) AS meant,
            json_extract(a.value, '$.likelihoods') AS likelihoods,
            json_extract(a.value, '$.yes') > json_extract(a.value, '$.no') AS first_is_likelier,
            (SELECT COUNT(*) FROM json_each(a.value, '$.likelihoods') WHERE value =
              (SELECT MAX(value) FROM json_each(a.value, '$.likelihoods'))) AS n_likeliest,
            (SELECT MIN(key) FROM json_each(a.value, '$.likelihoods') WHERE value =
              (SELECT MAX(value) FROM json_each(a.value, '$.likelihoods'))) AS likeliest
          FROM sessions s, json_each(s.body, '$.answers') a
          WHERE json_extract(a.value, '$.fate') IS NOT 'dropped');
      CREATE VIEW error_counts AS
        SELECT user, device,
          SUM(n_answers = 2 AND meant = 0 AND said = 0) AS meant_yes_said_yes,
          SUM(n_answers = 2 AND meant = 0 AND said = 1) AS meant_yes_said_no,
          SUM(n_answers = 2 AND meant = 1 AND said = 0) AS meant_no_said_yes,
          SUM(n_answers = 2 AND meant = 1 AND said = 1) AS meant_no_said_no,
          SUM(n_answers > 2 AND meant = said) AS chose_right,
          SUM(n_answers > 2 AND meant <> said) AS chose_wrong
        FROM answers GROUP BY user, device;
      CREATE TRIGGER tasks_are_never_changed BEFORE UPDATE ON tasks
        BEGIN SELECT RAISE(ABORT, 'tasks are append-only'); END;
      CREATE TRIGGER tasks_are_never_deleted BEFORE DELETE ON tasks
        BEGIN SELECT RAISE(ABORT, 'tasks are append-only'); END;
      CREATE TRIGGER task_states_are_never_changed BEFORE UPDATE ON task_states
        BEGIN SELECT RAISE(ABORT, 'task states are append-only'); END;
      CREATE TRIGGER task_states_are_never_deleted BEFORE DELETE ON task_states
        BEGIN SELECT RAISE(ABORT, 'task states are append-only'); END;
      CREATE TRIGGER stops_are_never_changed BEFORE UPDATE ON stops
        BEGIN SELECT RAISE(ABORT, 'stops are append-only'); END;
      CREATE TRIGGER stops_are_never_deleted BEFORE DELETE ON stops
        BEGIN SELECT RAISE(ABORT, 'stops are append-only'); END;
    )sql",
    kSchemaStep4};

int PragmaValue(SQLite::Database& database, const char* pragma) {
  return database.execAndGet(std::string("PRAGMA ") + pragma).getInt();
}

}  // namespace

Error Explain(const SQLite::Exception& error, const std::string& path) {
  switch (error.getErrorCode()) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return Error{path +
                   ": the database is locked by another process; end it, or use another --db"};
    case SQLITE_READONLY:
      return Error{path +
                   ": the database is read-only; make the file and its folder writable, or use "
                   "another --db"};
    case SQLITE_CANTOPEN:
      return Error{path + ": cannot open the database; the folder must exist and be writable"};
    case SQLITE_NOTADB:
      return Error{
          path +
          ": is not a database (expected an SQLite file of beckon-intention); use another --db"};
    case SQLITE_CORRUPT:
      return Error{path + ": the database is damaged (" + error.what() +
                   "); put it aside and import a backup (beckon-intention import)"};
    case SQLITE_FULL:
      return Error{path + ": the disk is full; make room"};
    default:
      return Error{path + ": database error: " + error.what()};
  }
}

Status CheckVersion(SQLite::Database& database, const std::string& path) {
  const int version = PragmaValue(database, "user_version");
  const int application = PragmaValue(database, "application_id");
  const int tables = database.execAndGet("SELECT COUNT(*) FROM sqlite_master").getInt();
  if (application != kApplicationId && (version != 0 || tables != 0)) {
    return Error{path + ": is a database of another program; use another --db"};
  }
  if (version > kSchemaVersion) {
    return Error{path + ": was written by a newer version (schema " + std::to_string(version) +
                 ", this program knows " + std::to_string(kSchemaVersion) +
                 "); update beckon-intention"};
  }
  return {};
}

/// One step, in a transaction: another process may be doing the same. False: there is none left.
static bool MigrateOnce(SQLite::Database& database) {
  SQLite::Transaction step(database, SQLite::TransactionBehavior::IMMEDIATE);
  const int version = PragmaValue(database, "user_version");
  if (version >= kSchemaVersion) return false;
  database.exec(kSteps[static_cast<size_t>(version)]);
  database.exec("PRAGMA application_id = " + std::to_string(kApplicationId));
  database.exec("PRAGMA user_version = " + std::to_string(version + 1));
  step.commit();
  return true;
}

Status Migrate(SQLite::Database& database, const std::string& path) {
  if (Status known = CheckVersion(database, path); !known) return known;
  AddFunctions(database);
  bool changed = false;
  while (MigrateOnce(database)) changed = true;
  // What a step erased does not stay in the log.
  if (changed) database.tryExec("PRAGMA wal_checkpoint(TRUNCATE)");
  return {};
}

}  // namespace beckon::intention
