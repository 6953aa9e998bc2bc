// Forgetting: a row that travels, is obeyed wherever it arrives, and leaves nothing to read.
#include <SQLiteCpp/SQLiteCpp.h>

#include <nlohmann/json.hpp>

#include "services/intention/store.h"
#include "services/intention/store_rows.h"
#include "services/intention/store_try.h"

namespace beckon::intention {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

bool Finds(SQLite::Statement& query) {
  const bool found = query.executeStep();
  query.reset();
  return found;
}

std::vector<std::string> Texts(SQLite::Statement& query) {
  std::vector<std::string> texts;
  while (query.executeStep()) texts.push_back(query.getColumn(0).getString());
  query.reset();
  return texts;
}

std::string Member(const json& body, const char* key) {
  const auto found = body.find(key);
  return found != body.end() && found->is_string() ? found->get<std::string>() : "";
}

}  // namespace

void Store::EraseUid(const std::string& uid) {
  auto& rows = Prepared(
      "UPDATE rows SET kind = 'erased', user = '', "
      "body = json_object('hash', printf('%016x', hash), 'uid', uid) "
      "WHERE uid = ? AND kind NOT IN ('erased', 'forget')");
  rows.bind(1, uid);
  erased_ = rows.exec() > 0 || erased_;
  rows.reset();
  constexpr std::string_view kSession = "session/";
  if (!uid.starts_with(kSession)) return;
  auto& tasks = Prepared("UPDATE tasks SET encoded = x'' WHERE task_id = ? AND encoded <> x''");
  tasks.bind(1, uid.substr(kSession.size()));
  tasks.exec();
  tasks.reset();
}

void Store::EraseLabelsOf(const std::string& session_id) {
  auto& query = Prepared(
      "SELECT uid FROM rows WHERE kind = 'label' AND json_extract(body, '$.session_id') = ?");
  query.bind(1, session_id);
  for (const std::string& uid : Texts(query)) EraseUid(uid);
}

void Store::Obey(const std::string& text, const std::string& user) {
  const json body = json::parse(text);
  if (const std::string session = Member(body, "session_id"); !session.empty()) {
    EraseUid("session/" + session);
    EraseLabelsOf(session);
  }
  const auto covers = body.find("covers");
  if (covers == body.end() || !covers->is_object()) return;
  for (const auto& [origin, seq] : covers->items()) {
    if (!seq.is_number_integer()) continue;
    auto& query = Prepared(
        "SELECT uid FROM rows WHERE user = ? AND origin = ? AND seq <= ? "
        "AND kind NOT IN ('erased', 'forget')");
    query.bind(1, user);
    query.bind(2, origin);
    query.bind(3, seq.get<int64_t>());
    for (const std::string& uid : Texts(query)) EraseUid(uid);
  }
}

bool Store::IsForgotten(const HistoryRow& row, const RowHead& head) {
  if (row.kind == kErased || row.kind == kForget) return false;
  auto& erased = Prepared("SELECT 1 FROM rows WHERE uid = ? AND kind = 'erased'");
  erased.bind(1, head.uid);
  if (Finds(erased)) return true;
  auto& covered = Prepared(
      "SELECT 1 FROM rows f, json_each(f.body, '$.covers') c WHERE f.kind = 'forget' "
      "AND json_extract(f.body, '$.covers') IS NOT NULL AND f.user = ? AND c.key = ? "
      "AND c.value >= ?");
  covered.bind(1, head.user);
  covered.bind(2, row.origin);
  covered.bind(3, row.seq);
  if (Finds(covered)) return true;
  std::string session;
  if (row.kind == "session") session = head.uid.substr(head.uid.find('/') + 1);
  if (row.kind == "label") session = Member(json::parse(row.body), "session_id");
  if (session.empty()) return false;
  auto& named = Prepared(
      "SELECT 1 FROM rows WHERE kind = 'forget' AND json_extract(body, '$.session_id') = ?");
  named.bind(1, session);
  return Finds(named);
}

void Store::AddForeign(const HistoryRow& row, const RowHead& head, Utime now) {
  const bool forgotten = IsForgotten(row, head);
  InsertRow(row, head);
  if (forgotten || row.kind == kErased) EraseUid(head.uid);
  if (row.kind != kForget) return;
  Obey(row.body, head.user);
  Echo(row, head, now);
}

/// A mark in this machine's own sequence: what it wrote of the user until here was written without
/// knowing of the forgetting. Rows of another origin are covered as far as they are here, unless
/// that origin's own mark is among them: what follows a mark is a new beginning.
void Store::Echo(const HistoryRow& forget, const RowHead& head, Utime now) {
  const json body = json::parse(forget.body);
  if (!body.value("everywhere", false)) return;  // of a single session, an echo, an older version
  const char* const marks =
      "SELECT 1 FROM rows WHERE kind = 'forget' AND user = ? "
      "AND json_extract(body, '$.covers') IS NOT NULL AND origin = ? "
      "AND (json_extract(body, '$.echo') = ? OR uid = ?)";
  const auto marked = [&](const std::string& origin) {
    auto& query = Prepared(marks);
    query.bind(1, head.user);
    query.bind(2, origin);
    query.bind(3, head.uid);
    query.bind(4, head.uid);
    return Finds(query);
  };
  if (marked(origin_)) return;
  ordered_json echo = {{"user", head.user},
                       {"utime", now == 0 ? head.utime : now},
                       {"covers", ordered_json::object()},
                       {"echo", head.uid}};
  SQLite::Statement known(*database_,
                          "SELECT origin, MAX(seq) FROM rows WHERE user = ? "
                          "AND kind NOT IN ('erased', 'forget') GROUP BY origin");
  known.bind(1, head.user);
  while (known.executeStep()) {
    const std::string origin = known.getColumn(0).getString();
    if (origin == origin_ || !marked(origin))
      echo["covers"][origin] = known.getColumn(1).getInt64();
  }
  const std::string uid = "forget/" + origin_ + "/" + std::to_string(NextSeq(origin_));
  echo["uid"] = uid;
  const std::string text = echo.dump();
  Insert(kForget, {uid, head.user, echo["utime"]}, text, now);
  Obey(text, head.user);
}

void Store::Scrub() {
  if (!erased_) return;
  erased_ = false;
  // Does nothing where another process reads just now; closing the database does it then.
  database_->tryExec("PRAGMA wal_checkpoint(TRUNCATE)");
}

Result<int> Store::ForgetUser(const std::string& user, Utime now) {
  auto forgotten = Try<int>([&]() -> Result<int> {
    SQLite::Transaction transaction(*database_, kImmediate);
    SQLite::Statement sessions(*database_, "SELECT COUNT(*) FROM sessions WHERE user = ?");
    sessions.bind(1, user);
    sessions.executeStep();
    const int count = sessions.getColumn(0).getInt();
    const std::string uid = "forget/" + origin_ + "/" + std::to_string(NextSeq(origin_));
    ordered_json body = {{"user", user},
                         {"utime", now},
                         {"covers", ordered_json::object()},
                         {"everywhere", true},
                         {"uid", uid}};
    SQLite::Statement seqs(*database_,
                           "SELECT origin, MAX(seq) FROM rows WHERE user = ? GROUP BY origin");
    seqs.bind(1, user);
    while (seqs.executeStep())
      body["covers"][seqs.getColumn(0).getString()] = seqs.getColumn(1).getInt64();
    if (body["covers"].empty()) return Error{path_ + ": knows nothing of user '" + user + "'"};
    Insert(kForget, {uid, user, now}, body.dump(), now);
    Obey(body.dump(), user);
    transaction.commit();
    Advance(origin_);
    return count;
  });
  Scrub();
  return forgotten;
}

Result<SessionRecord> Store::ForgetLast(const std::string& user, Utime now) {
  auto forgotten = Try<SessionRecord>([&]() -> Result<SessionRecord> {
    SQLite::Transaction transaction(*database_, kImmediate);
    std::string last;
    {
      SQLite::Statement query(*database_,
                              "SELECT body FROM sessions WHERE ?1 = '' OR user = ?1 "
                              "ORDER BY hybrid_utime DESC, origin DESC, seq DESC LIMIT 1");
      query.bind(1, user);
      if (!query.executeStep()) return Error{path_ + ": there is no session to forget"};
      last = query.getColumn(0).getString();
    }
    const auto session = SessionFromBody(last);
    if (!session) return session.error();
    const std::string uid = "forget/" + origin_ + "/" + std::to_string(NextSeq(origin_));
    const ordered_json body = {{"session_id", session->session_id}, {"utime", now}, {"uid", uid}};
    Insert(kForget, {uid, session->user, now}, body.dump(), now);
    Obey(body.dump(), session->user);
    transaction.commit();
    Advance(origin_);
    return *session;
  });
  Scrub();
  return forgotten;
}

}  // namespace beckon::intention
