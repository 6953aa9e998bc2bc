// The step from schema 3 to 4: rows that several machines share.
#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include "services/intention/core/history_row.h"
#include "services/intention/store_schema.h"

namespace beckon::intention {
namespace {

std::string Text(sqlite3_value* value) {
  const auto* text = reinterpret_cast<const char*>(sqlite3_value_text(value));
  return text == nullptr ? "" : std::string(text, static_cast<size_t>(sqlite3_value_bytes(value)));
}

void HashOfRow(sqlite3_context* context, int, sqlite3_value** values) {
  HistoryRow row;
  row.origin = Text(values[0]);
  row.seq = sqlite3_value_int64(values[1]);
  row.hybrid_utime = sqlite3_value_int64(values[2]);
  row.kind = Text(values[3]);
  row.body = Text(values[4]);
  sqlite3_result_int64(context, static_cast<int64_t>(RowHash(row)));
}

}  // namespace

void AddFunctions(SQLite::Database& database) {
  database.createFunction("row_hash", 5, true, nullptr, HashOfRow, nullptr, nullptr, nullptr);
}

// 4: hybrid logical time; a checksum of each row; ids that several machines may have rows of; what
// was forgotten is erased, so that the views need not look it up; under which name this machine
// writes. Nothing is ever changed but by erasing, and by moving a row to another number.
const char* const kSchemaStep4 = R"sql(
  DROP VIEW IF EXISTS error_counts;
  DROP VIEW IF EXISTS answers;
  DROP VIEW IF EXISTS counts;
  DROP VIEW IF EXISTS labels;
  DROP VIEW IF EXISTS sessions;
  CREATE TABLE rows_4 (
    origin TEXT NOT NULL CHECK (origin <> ''),
    seq INTEGER NOT NULL CHECK (seq >= 1),
    kind TEXT NOT NULL,              -- session, label, forget, erased, ...
    uid TEXT NOT NULL,               -- e.g. session/<session id>; rows of one uid count once
    user TEXT NOT NULL,
    utime INTEGER NOT NULL,          -- us since the epoch
    hybrid_utime INTEGER NOT NULL CHECK (hybrid_utime >= 1),
    hash INTEGER NOT NULL,           -- of the row as it was written
    body TEXT NOT NULL CHECK (json_valid(body)),
    PRIMARY KEY (origin, seq)
  );
  INSERT INTO rows_4
    SELECT origin, seq, kind, uid, user, utime, MAX(utime, 1),
      row_hash(origin, seq, MAX(utime, 1), kind, body), body
    FROM rows ORDER BY rowid;
  UPDATE rows_4 AS r SET kind = 'erased', user = '',
      body = json_object('hash', printf('%016x', hash), 'uid', uid)
    WHERE kind IN ('session', 'label') AND (
      EXISTS (SELECT 1 FROM forgets f WHERE r.uid = 'session/' || f.session_id
        OR (r.kind = 'label' AND json_extract(r.body, '$.session_id') = f.session_id))
      OR EXISTS (SELECT 1 FROM forgets f, json_each(f.covers) c
        WHERE f.user = r.user AND c.key = r.origin AND c.value >= r.seq));
  DROP VIEW IF EXISTS forgets;
  DROP TABLE rows;
  ALTER TABLE rows_4 RENAME TO rows;
  CREATE INDEX rows_by_user ON rows (kind, user, hybrid_utime);
  CREATE INDEX rows_by_uid ON rows (uid);
  CREATE INDEX rows_by_time ON rows (hybrid_utime);
  CREATE INDEX labels_by_session ON rows (json_extract(body, '$.session_id')) WHERE kind = 'label';
  CREATE INDEX forgets_by_session ON rows (json_extract(body, '$.session_id')) WHERE kind = 'forget';
  CREATE INDEX forgets_of_users ON rows (user)
    WHERE kind = 'forget' AND json_extract(body, '$.covers') IS NOT NULL;
  CREATE TRIGGER rows_are_only_erased BEFORE UPDATE ON rows
    WHEN NOT (OLD.kind NOT IN ('erased', 'forget') AND NEW.kind = 'erased' AND NEW.user = ''
      AND NEW.origin = OLD.origin AND NEW.seq = OLD.seq AND NEW.uid = OLD.uid
      AND NEW.utime = OLD.utime AND NEW.hybrid_utime = OLD.hybrid_utime AND NEW.hash = OLD.hash
      AND NEW.body = json_object('hash', printf('%016x', OLD.hash), 'uid', OLD.uid))
    BEGIN SELECT RAISE(ABORT, 'the history is append-only'); END;
  CREATE TRIGGER rows_are_only_moved BEFORE DELETE ON rows
    WHEN NOT EXISTS (SELECT 1 FROM rows r WHERE r.uid = OLD.uid AND r.origin <> OLD.origin
      AND (r.kind = OLD.kind OR r.kind = 'erased'))
    BEGIN SELECT RAISE(ABORT, 'the history is append-only'); END;
  DROP TRIGGER IF EXISTS tasks_are_never_changed;
  CREATE TRIGGER tasks_are_only_erased BEFORE UPDATE ON tasks
    WHEN NOT (NEW.task_id = OLD.task_id AND NEW.encoded = x'' AND OLD.encoded <> x'')
    BEGIN SELECT RAISE(ABORT, 'tasks are append-only'); END;
  UPDATE tasks SET encoded = x'' WHERE encoded <> x'' AND EXISTS
    (SELECT 1 FROM rows WHERE kind = 'erased' AND uid = 'session/' || task_id);
  CREATE TABLE identities (
    machine TEXT NOT NULL,           -- as configured
    host TEXT NOT NULL,              -- a checksum of the computer's id; empty: it has none
    origin TEXT NOT NULL,            -- under which this machine writes from then on
    reason TEXT NOT NULL             -- why not under its name; empty: under its name
  );
  CREATE TRIGGER identities_are_never_changed BEFORE UPDATE ON identities
    BEGIN SELECT RAISE(ABORT, 'identities are append-only'); END;
  CREATE TRIGGER identities_are_never_deleted BEFORE DELETE ON identities
    BEGIN SELECT RAISE(ABORT, 'identities are append-only'); END;
  CREATE VIEW sessions AS
    SELECT origin, seq, user, utime, hybrid_utime, body,
      substr(uid, length('session/') + 1) AS session_id,
      json_extract(body, '$.category') AS category,
      json_extract(body, '$.action') AS action,
      json_extract(body, '$.instance') AS instance,
      json_extract(body, '$.questions') AS questions,
      json_extract(body, '$.device') AS device
    FROM rows r WHERE kind = 'session' AND NOT EXISTS (SELECT 1 FROM rows o WHERE o.uid = r.uid
      AND o.kind = 'session' AND (o.hybrid_utime, o.origin, o.seq) < (r.hybrid_utime, r.origin, r.seq));
  CREATE VIEW labels AS
    SELECT origin, seq, user, utime, hybrid_utime, body,
      json_extract(body, '$.session_id') AS session_id,
      json_extract(body, '$.category') AS category,
      json_extract(body, '$.source') AS source
    FROM rows r WHERE kind = 'label' AND NOT EXISTS (SELECT 1 FROM rows o WHERE o.uid = r.uid
      AND o.kind = 'label' AND (o.hybrid_utime, o.origin, o.seq) < (r.hybrid_utime, r.origin, r.seq));
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
)sql";

}  // namespace beckon::intention
