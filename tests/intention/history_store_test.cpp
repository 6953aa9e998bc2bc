// The store as several machines share it: order, forgetting, copies, damage.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>

#include "services/intention/store.h"
#include "services/intention/store_recovery.h"
#include "services/intention/store_schema.h"
#include "tests/intention/history_fixture.h"
#include "tests/intention/store_records.h"
#include "tests/intention/temporary_folder.h"

namespace beckon::intention {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr Utime kDay = 24 * 3600 * kSecond;
constexpr Utime kNow = 1'800'000'000 * kSecond;

class HistoryStoreTest : public testing::Test {
 protected:
  std::unique_ptr<Store> Open(const std::string& name, const std::string& machine = "") {
    auto store = Store::Open(Path(name), machine.empty() ? name : machine);
    EXPECT_TRUE(store.ok()) << (store ? "" : store.error().message);
    return store ? *std::move(store) : nullptr;
  }
  std::string Path(const std::string& name) const { return folder / (name + ".db"); }
  static void Commit(Store& store, const std::string& id, const std::string& user = "ann",
                     Utime utime = kNow, const std::vector<LabelRecord>& labels = {}) {
    const auto session = Session(id, user, utime);
    const auto committed = store.Commit(session, labels, TaskOf(session));
    ASSERT_TRUE(committed.ok()) << committed.error().message;
    EXPECT_TRUE(*committed);
  }
  static std::vector<std::string> Ids(Store& store) {
    std::vector<std::string> ids;
    const auto sessions = store.AllSessions();
    EXPECT_TRUE(sessions.ok());
    for (const auto& session : *sessions) ids.push_back(session.session_id);
    return ids;
  }
  static std::multiset<std::string> Set(const std::vector<std::string>& ids) {
    return {ids.begin(), ids.end()};
  }
  /// Every row as text, and what the views make of them.
  static std::string Content(Store& store) {
    std::string text;
    const auto rows = store.Rows();
    for (const auto& r : *rows) {
      text += r.origin + " " + std::to_string(r.seq) + " " + std::to_string(r.hybrid_utime) + " " +
              r.kind + " " + r.body + "\n";
    }
    for (const std::string& id : Ids(store)) text += id + "\n";
    return text;
  }
  static void Give(Store& from, Store& to) {
    const auto rows = from.Rows();
    const auto added = to.AddRows(*rows, kNow);
    ASSERT_TRUE(added.ok()) << added.error().message;
  }
  /// Of all files of a database.
  bool OnDisk(const std::string& name, const std::string& text) const {
    for (const char* with : {"", "-wal"}) {
      std::ifstream file(Path(name) + with, std::ios::binary);
      const std::string bytes((std::istreambuf_iterator<char>(file)), {});
      if (bytes.find(text) != std::string::npos) return true;
    }
    return false;
  }
  TemporaryFolder folder;
};

TEST_F(HistoryStoreTest, TheLastIsTheLastThoughItsClockIsWrong) {
  const auto a = Open("a"), b = Open("b");
  Commit(*a, "s1", "ann", kNow);
  Give(*a, *b);
  Commit(*b, "s2", "ann", kNow - 3600 * kSecond);  // knows of s1
  Give(*b, *a);
  Commit(*a, "s3", "ann", kNow - 7200 * kSecond);  // the clock was set back
  Give(*a, *b);
  for (Store* store : {a.get(), b.get()}) {
    EXPECT_THAT(Ids(*store), ElementsAre("s1", "s2", "s3"));
    const auto sessions = store->SessionsOf("ann");
    EXPECT_EQ(sessions->back().session_id, "s3");
    EXPECT_EQ(sessions->back().utime, kNow - 7200 * kSecond);  // what was said stays
  }
  EXPECT_EQ(a->ForgetLast("ann", kNow)->session_id, "s3");
}

TEST_F(HistoryStoreTest, ARowOfTheFarFutureDragsNobodyAlong) {
  const auto a = Open("a"), b = Open("b");
  Commit(*a, "s1", "ann", kNow + 400 * kDay);
  const auto taken = b->Take(*a->Rows(), kNow);
  ASSERT_TRUE(taken.ok());
  EXPECT_EQ(taken->added, 1);
  EXPECT_EQ(taken->far_future, 1);
  Commit(*b, "s2", "ann", kNow);
  EXPECT_EQ(b->RowsAfter("b", 0, 1, 1000)->front().hybrid_utime, kNow);
  Give(*a, *b);
  Commit(*b, "s3", "ann", kNow);
  EXPECT_EQ(b->RowsAfter("b", 1, 1, 1000)->front().hybrid_utime, kNow + 1);
}

TEST_F(HistoryStoreTest, ASessionOnTwoMachinesCountsOnceAndAlikeEverywhere) {
  const auto a = Open("a"), b = Open("b"), c = Open("c");
  Commit(*b, "s1", "ann", kNow + 5);
  Commit(*a, "s1", "bob", kNow + 9);
  Give(*a, *c);
  Give(*b, *c);
  Give(*a, *b);
  Give(*b, *a);
  for (Store* store : {a.get(), b.get(), c.get()}) {
    EXPECT_THAT(Ids(*store), ElementsAre("s1"));
    EXPECT_EQ((*store->FindSession("s1"))->user, "ann");  // the earlier one
    EXPECT_EQ(store->SessionsOf("ann")->size(), 1u);
    EXPECT_TRUE(store->SessionsOf("bob")->empty());
  }
  SQLite::Database raw(Path("c"));
  EXPECT_EQ(raw.execAndGet("SELECT SUM(n) FROM counts").getInt(), 1);
}

TEST_F(HistoryStoreTest, AForgottenSessionStaysForgottenWhenItArrivesLate) {
  const auto a = Open("a"), b = Open("b"), c = Open("c");
  Commit(*a, "s1", "ann", kNow, {Label("l1")});
  Commit(*a, "s2", "ann", kNow);
  Give(*a, *b);
  ASSERT_TRUE(b->ForgetLast("ann", kNow).ok());  // s2
  auto rows = *b->Rows();
  std::reverse(rows.begin(), rows.end());  // the forgetting first
  ASSERT_TRUE(c->AddRows(rows, kNow).ok());
  ASSERT_TRUE(c->AddRows(*a->Rows(), kNow).ok());
  EXPECT_THAT(Ids(*c), ElementsAre("s1"));
  EXPECT_EQ(c->LabelsOf("camera")->size(), 1u);
  ASSERT_TRUE(b->ForgetUser("ann", kNow).ok());
  Give(*b, *c);
  EXPECT_THAT(Ids(*c), IsEmpty());
  EXPECT_THAT(*c->LabelsOf("camera"), IsEmpty());
  EXPECT_TRUE(c->FindSession("s1")->has_value());  // its id stays taken
  Give(*c, *a);
  Give(*a, *c);
  Give(*a, *b);
  EXPECT_THAT(Ids(*a), IsEmpty());
  EXPECT_EQ(Content(*a), Content(*c));
  EXPECT_EQ(Content(*a), Content(*b));
}

TEST_F(HistoryStoreTest, ForgettingReachesWhatTheForgetterDidNotKnow) {
  const auto a = Open("a"), b = Open("b"), c = Open("c");
  Commit(*a, "s1");
  Commit(*b, "s2");  // a does not know of it
  Commit(*b, "s3", "bob");
  Give(*b, *c);  // nor of c's copy
  ASSERT_TRUE(a->ForgetUser("ann", kNow + 1).ok());
  Give(*a, *c);
  EXPECT_THAT(Ids(*c), ElementsAre("s3"));
  Give(*a, *b);
  EXPECT_THAT(Ids(*b), ElementsAre("s3"));
  Commit(*b, "s4", "ann", kNow + 2);  // a new beginning
  EXPECT_THAT(Ids(*b), ElementsAre("s3", "s4"));
  for (int i = 0; i < 3; ++i) {  // echoes make no echoes
    Give(*a, *b), Give(*b, *c), Give(*c, *a);
  }
  const int64_t rows = *a->RowCount();
  Give(*b, *a), Give(*c, *a);
  EXPECT_EQ(*a->RowCount(), rows);
  for (Store* store : {a.get(), b.get(), c.get()}) {
    EXPECT_THAT(Ids(*store), ElementsAre("s3", "s4"));
    EXPECT_EQ(Content(*store), Content(*a));
  }
}

TEST_F(HistoryStoreTest, WhatIsForgottenCannotBeReadOnAnyDisk) {
  const auto a = Open("a"), b = Open("b");
  auto secret = Session("s1");
  secret.device = "very-secret-device";
  for (int i = 0; i < 30; ++i) Commit(*a, "f" + std::to_string(i), "bob");
  ASSERT_TRUE(*a->Commit(secret, {}, TaskOf(secret)));
  for (int i = 30; i < 60; ++i) Commit(*a, "f" + std::to_string(i), "bob");
  Give(*a, *b);
  EXPECT_TRUE(OnDisk("a", "very-secret-device"));
  ASSERT_TRUE(a->ForgetUser("ann", kNow).ok());
  EXPECT_FALSE(OnDisk("a", "very-secret-device"));
  EXPECT_TRUE(OnDisk("b", "very-secret-device"));
  Give(*a, *b);
  EXPECT_FALSE(OnDisk("b", "very-secret-device"));
  EXPECT_EQ(a->Heads().at("a").seq, 62);
  EXPECT_EQ(a->Heads().at("a"), b->Heads().at("a"));  // still the same chain
  EXPECT_THAT(*a->OpenTasks(), testing::Each(testing::Field(&msg::Task::user, "bob")));
}

TEST_F(HistoryStoreTest, OnlyErasingAndMovingChangeARow) {
  const auto a = Open("a");
  Commit(*a, "s1");
  SQLite::Database raw(Path("a"), SQLite::OPEN_READWRITE);
  for (const char* sql :
       {"UPDATE rows SET kind = 'erased'",
        "UPDATE rows SET kind = 'erased', user = '', body = '{}'", "UPDATE rows SET hash = 1",
        "DELETE FROM rows", "UPDATE tasks SET encoded = x'00'"})
    EXPECT_THROW(raw.exec(sql), SQLite::Exception) << sql;
}

TEST_F(HistoryStoreTest, RowsOfNewerVersionsArePassedOn) {
  const auto a = Open("a"), b = Open("b"), c = Open("c");
  ASSERT_EQ(*a->AddRows({{"x", 1, "gesture", R"({"user":"ann","wave":3})", kNow}}), 1);
  const auto rows = a->RowsAfter("x", 0, 10, 1000);
  ASSERT_EQ(b->Take(*rows, kNow)->added, 1);
  ASSERT_EQ(c->Take(*b->RowsAfter("x", 0, 10, 1000), kNow)->added, 1);
  EXPECT_EQ(a->Heads(), c->Heads());
  EXPECT_THAT(Ids(*c), IsEmpty());
  ASSERT_TRUE(c->ForgetUser("ann", kNow).ok());
  EXPECT_FALSE(OnDisk("c", "wave"));
}

TEST_F(HistoryStoreTest, ABadRowIsRefusedAlone) {
  const auto a = Open("a"), b = Open("b");
  for (int i = 0; i < 4; ++i) Commit(*a, "s" + std::to_string(i));
  auto rows = *a->Rows();
  rows[2].body = "{}";
  rows.push_back({"x", 1, "note", "{}", kNow});
  const auto taken = b->Take(rows, kNow);
  ASSERT_TRUE(taken.ok());
  EXPECT_EQ(taken->added, 3);
  EXPECT_EQ(taken->refused.at("body"), 1);
  EXPECT_EQ(b->Heads().at("a").seq, 2);
  EXPECT_EQ(b->Take(*a->RowsAfter("a", 2, 9, 9999), kNow)->added, 2);
  EXPECT_EQ(b->Heads().at("a"), a->Heads().at("a"));
}

TEST_F(HistoryStoreTest, SeesWhatAnotherProcessWrote) {
  const auto a = Open("a"), other = Open("a"), b = Open("b");
  Commit(*b, "s9");
  Commit(*a, "s1");
  EXPECT_EQ(a->Heads().size(), 1u);
  Commit(*other, "s2");
  Give(*b, *other);
  ASSERT_TRUE(a->Refresh().ok());
  EXPECT_EQ(a->Heads(), other->Heads());
  EXPECT_EQ(a->Heads().at("a").seq, 2);
}

TEST_F(HistoryStoreTest, ASessionOfManyAnswersStillFitsAMessage) {
  const auto a = Open("a");
  auto session = Session("s1");
  session.answers.assign(120,
                         {QuestionKind::kChoice, std::vector<double>(64, 1.0 / 3), 1, "switch"});
  ASSERT_TRUE(*a->Commit(session, {}, TaskOf(session)));
  EXPECT_LE(a->Rows()->front().body.size(), Store::kMostBody);
  EXPECT_GT(a->AllSessions()->front().answers.size(), 10u);
}

// A disk is copied; the copy and the original go on, each unknown to the other, then both meet and
// meet a third machine, which knows one of the branches.
TEST_F(HistoryStoreTest, CopiesOfADatabaseMeetWithoutLossOrDoubles) {
  for (uint64_t seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE(seed);
    const std::string n = std::to_string(seed);
    std::vector<std::string> all;
    const auto write = [&](Store& store, const std::string& id) {
      Commit(store, id, id.size() % 2 == 0 ? "ann" : "bob", kNow + static_cast<Utime>(all.size()));
      all.push_back(id);
    };
    {
      const auto first = Open("first" + n, "kitchen");
      for (int i = 0; i < 5; ++i) write(*first, "s" + std::to_string(i));
    }
    std::filesystem::copy(Path("first" + n), Path("copy" + n));
    const auto first = Open("first" + n, "kitchen"), copy = Open("copy" + n, "kitchen");
    const auto third = Open("third" + n, "bedroom");
    for (int i = 0; i < 4; ++i) write(*first, "first" + std::to_string(i));
    for (int i = 0; i < 7; ++i) write(*copy, "copy" + std::to_string(i));
    ASSERT_TRUE(copy->CommitLabels({Label("l1")}).ok());
    if (seed % 2 == 0) Give(*first, *third);
    if (seed % 3 == 0) {
      ASSERT_TRUE(copy->ForgetLast("", kNow).ok());
      all.pop_back();
    }
    HistoryNetwork network(seed);
    for (Store* store : {first.get(), copy.get(), third.get()}) network.Add(*store);
    EXPECT_LE(network.RunUntilEqual(8 * kSecond), 5 * kSecond);
    write(*first, "later");
    network.RunUntilEqual(5 * kSecond);
    for (Store* store : {first.get(), copy.get(), third.get()}) {
      EXPECT_EQ(Set(Ids(*store)), Set(all));
      EXPECT_EQ(Content(*store), Content(*third));
      EXPECT_EQ(store->LabelsOf("camera")->size(), 1u);
    }
    EXPECT_NE(first->WriteOrigin(), copy->WriteOrigin());
    EXPECT_THAT(first->WriteOrigin(), StartsWith("kitchen~"));
  }
}

TEST_F(HistoryStoreTest, TheNewNameOutlivesTheProcess) {
  std::string name;
  {
    const auto a = Open("a");
    ASSERT_TRUE(a->LeaveOrigin("a copy", kNow).ok());
    name = a->WriteOrigin();
    EXPECT_THAT(name, testing::MatchesRegex("a~[0-9a-f]{4}"));
    Commit(*a, "s1");
  }
  EXPECT_EQ(Open("a")->WriteOrigin(), name);
  EXPECT_EQ(Open("a")->origin_reason(), "a copy");
  EXPECT_EQ(Open("a", "renamed")->WriteOrigin(), "renamed");
}

TEST_F(HistoryStoreTest, ADatabaseFromAnotherComputerGetsANewName) {
  Commit(*Open("a"), "s1");
  SQLite::Database(Path("a"), SQLite::OPEN_READWRITE)
      .exec("INSERT INTO identities VALUES ('a', 'elsewhere', 'a', '')");
  const bool known = std::filesystem::exists("/etc/machine-id") &&
                     std::filesystem::file_size("/etc/machine-id") > 0;
  const auto store = Open("a");
  EXPECT_EQ(store->WriteOrigin() != "a", known);
}

// Random lives of three stores, with forgetting, cut apart and joined: the same rows, the same
// bodies, the same views everywhere.
TEST_F(HistoryStoreTest, RandomLivesConverge) {
  for (uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    std::vector<std::unique_ptr<Store>> stores;
    HistoryNetwork network(seed);
    network.loss = 0.1;
    network.doubling = 0.1;
    network.delay = 40'000;
    for (const char* name : {"a", "b", "c"}) {
      stores.push_back(Open(name + std::to_string(seed), name));
      network.Add(*stores.back());
    }
    int written = 0;
    for (int round = 0; round < 12; ++round) {
      const auto who = static_cast<size_t>(network.random() % 3);
      const std::string user = network.random() % 2 == 0 ? "ann" : "bob";
      if (round % 4 == 3) {
        if (network.random() % 2 == 0)
          (void)stores[who]->ForgetUser(user, kNow + network.now).ok();
        else
          (void)stores[who]->ForgetLast(user, kNow + network.now).ok();
      } else {
        Commit(*stores[who], std::to_string(seed) + "-" + std::to_string(++written), user,
               kNow + network.now);
      }
      network.machines[who].island = static_cast<int>(network.random() % 2);
      network.Run(static_cast<Utime>(network.random() % 60) * HistoryNetwork::kStep);
    }
    for (auto& machine : network.machines) machine.island = 0;
    network.Run(5 * kSecond);  // echoes are written after all is there
    EXPECT_LE(network.RunUntilEqual(6 * kSecond), 5 * kSecond);
    for (const auto& store : stores) ASSERT_EQ(Content(*store), Content(*stores[0]));
  }
}

TEST_F(HistoryStoreTest, OpensTheFilesOfTheThirdVersion) {
  // As version 3 wrote it; keep this text as it is.
  {
    SQLite::Database old(Path("a"), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    old.exec(R"sql(
      CREATE TABLE rows (origin TEXT NOT NULL CHECK (origin <> ''), seq INTEGER NOT NULL CHECK (seq >= 1),
        kind TEXT NOT NULL, uid TEXT NOT NULL UNIQUE, user TEXT NOT NULL, utime INTEGER NOT NULL,
        body TEXT NOT NULL CHECK (json_valid(body)), PRIMARY KEY (origin, seq));
      CREATE INDEX rows_by_user ON rows (kind, user, utime);
      CREATE TRIGGER rows_are_never_changed BEFORE UPDATE ON rows BEGIN SELECT RAISE(ABORT, 'the history is append-only'); END;
      CREATE TRIGGER rows_are_never_deleted BEFORE DELETE ON rows BEGIN SELECT RAISE(ABORT, 'the history is append-only'); END;
      CREATE TABLE tasks (task_id TEXT PRIMARY KEY, encoded BLOB NOT NULL);
      CREATE TABLE task_states (task_id TEXT NOT NULL, state INTEGER NOT NULL, utime INTEGER NOT NULL);
      CREATE INDEX task_states_by_task ON task_states (task_id);
      CREATE TABLE stops (utime INTEGER NOT NULL, stopped INTEGER NOT NULL CHECK (stopped IN (0, 1)));
      CREATE VIEW forgets AS
        SELECT json_extract(body, '$.session_id') AS session_id, json_extract(body, '$.user') AS user,
          json_extract(body, '$.covers') AS covers FROM rows WHERE kind = 'forget';
      CREATE VIEW sessions AS
        SELECT origin, seq, user, utime, body, substr(uid, length('session/') + 1) AS session_id,
          json_extract(body, '$.category') AS category, json_extract(body, '$.action') AS action,
          json_extract(body, '$.instance') AS instance, json_extract(body, '$.questions') AS questions,
          json_extract(body, '$.device') AS device
        FROM rows r WHERE kind = 'session'
          AND NOT EXISTS (SELECT 1 FROM forgets f WHERE r.uid = 'session/' || f.session_id)
          AND NOT EXISTS (SELECT 1 FROM forgets f, json_each(f.covers) c
            WHERE f.user = r.user AND c.key = r.origin AND c.value >= r.seq);
      CREATE VIEW labels AS SELECT origin, seq, user, utime, body FROM rows r WHERE kind = 'label';
      CREATE VIEW counts AS SELECT user, category, action, instance, COUNT(*) AS n FROM sessions GROUP BY user;
      CREATE VIEW answers AS SELECT user FROM sessions;
      CREATE VIEW error_counts AS SELECT user FROM answers;
      CREATE TRIGGER tasks_are_never_changed BEFORE UPDATE ON tasks BEGIN SELECT RAISE(ABORT, 'tasks are append-only'); END;
      CREATE TRIGGER tasks_are_never_deleted BEFORE DELETE ON tasks BEGIN SELECT RAISE(ABORT, 'tasks are append-only'); END;
      INSERT INTO rows VALUES ('a', 1, 'session', 'session/gone', 'ann', 5,
        '{"session_id":"gone","user":"ann","device":"secret","utime":5,"category":"Mug","action":"Drink","instance":1,"questions":4,"posterior":1.0,"answers":[]}');
      INSERT INTO rows VALUES ('a', 2, 'session', 'session/kept', 'bob', 6,
        '{"session_id":"kept","user":"bob","device":"console","utime":6,"category":"Mug","action":"Drink","instance":1,"questions":1,"posterior":1.0,"answers":[]}');
      INSERT INTO rows VALUES ('a', 3, 'forget', 'forget/a/3', 'ann', 7, '{"user":"ann","utime":7,"covers":{"a":1}}');
      INSERT INTO rows VALUES ('b', 1, 'session', 'session/undone', 'bob', 0,
        '{"session_id":"undone","user":"bob","device":"secret","utime":0,"category":"Mug","action":"Drink","instance":1,"questions":1,"posterior":1.0,"answers":[]}');
      INSERT INTO rows VALUES ('a', 4, 'forget', 'forget/a/4', 'bob', 8, '{"session_id":"undone","utime":8}');
      INSERT INTO tasks VALUES ('gone', x'0102');
      INSERT INTO stops VALUES (7, 1);
      PRAGMA application_id = 1111706446;
      PRAGMA user_version = 3;
    )sql");
  }
  const auto a = Open("a");
  EXPECT_THAT(Ids(*a), ElementsAre("kept"));
  EXPECT_TRUE(*a->Stopped());
  EXPECT_EQ(a->Heads().at("a").seq, 4);
  EXPECT_EQ(a->Rows()->back().hybrid_utime, 1);  // of "undone": no time is below 1
  EXPECT_FALSE(OnDisk("a", "secret"));
  EXPECT_TRUE(a->OpenTasks()->empty());
  // An export of the old version is the same history.
  const auto b = Open("b");
  ASSERT_EQ(*b->AddRows({{"a", 2, "session",
                          R"({"session_id":"kept","user":"bob","device":"console","utime":6,)"
                          R"("category":"Mug","action":"Drink","instance":1,"questions":1,)"
                          R"("posterior":1.0,"answers":[]})"}}),
            1);
  ASSERT_TRUE(a->AddRows(*b->Rows()).ok());
  EXPECT_EQ(SQLite::Database(Path("a")).execAndGet("PRAGMA user_version").getInt(), kSchemaVersion);
}

TEST_F(HistoryStoreTest, ADamagedDatabaseIsPutAsideAndBeginsAnewWithWhatIsSound) {
  const auto peer = Open("peer");
  {
    const auto store = Open("a");
    for (int i = 0; i < 100; ++i) Commit(*store, "s" + std::to_string(i));
    Give(*store, *peer);
    Commit(*store, "unshared");
  }
  std::fstream file(Path("a"), std::ios::in | std::ios::out | std::ios::binary);
  const std::string sound((std::istreambuf_iterator<char>(file)), {});
  const size_t body = sound.find("\"session_id\":\"s50\"");
  ASSERT_NE(body, std::string::npos);
  file.clear();
  file.seekp(static_cast<std::streamoff>(body / 4096 * 4096));
  file << std::string(4096, '\x5a');
  file.close();
  EXPECT_FALSE(Store::Open(Path("a"), "a").ok());
  auto opened = OpenOrReplace(Path("a"), "a", kNow);
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  EXPECT_THAT(opened->notice, HasSubstr("damaged"));
  EXPECT_TRUE(std::filesystem::exists(Path("a") + ".damaged-" + std::to_string(kNow)));
  Store& store = *opened->store;
  EXPECT_THAT(store.WriteOrigin(), StartsWith("a~"));
  EXPECT_TRUE(store.FindSession("unshared")->has_value());
  EXPECT_GT(Ids(store).size(), 50u);
  Commit(store, "new");
  HistoryNetwork network(1);
  network.Add(store);
  network.Add(*peer);
  network.RunUntilEqual(5 * kSecond);
  EXPECT_EQ(Ids(store).size(), 102u);
  EXPECT_EQ(Set(Ids(store)), Set(Ids(*peer)));
  EXPECT_TRUE(OpenOrReplace(Path("a"), "a", kNow)->notice.empty());
}

TEST_F(HistoryStoreTest, OnlyADamagedDatabaseIsPutAside) {
  std::ofstream(folder / "thesis.txt") << std::string(5000, 'x');
  EXPECT_FALSE(OpenOrReplace(folder / "thesis.txt", "a", kNow).ok());
  EXPECT_TRUE(std::filesystem::exists(folder / "thesis.txt"));
  {
    SQLite::Database other(Path("recipes"), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    other.exec("CREATE TABLE recipes (name TEXT)");
  }
  EXPECT_FALSE(OpenOrReplace(Path("recipes"), "a", kNow).ok());
  Open("newer");
  SQLite::Database(Path("newer"), SQLite::OPEN_READWRITE).exec("PRAGMA user_version = 99");
  EXPECT_FALSE(OpenOrReplace(Path("newer"), "a", kNow).ok());
  for (const auto& file : std::filesystem::directory_iterator(folder / ""))
    EXPECT_THAT(file.path().string(), testing::Not(HasSubstr("damaged")));
}

TEST_F(HistoryStoreTest, WhatCannotBeReadCountsAsStopped) {
  std::ofstream(Path("a"), std::ios::binary) << std::string(20'000, 'x');
  auto opened = OpenOrReplace(Path("a"), "a", kNow);
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  EXPECT_TRUE(*opened->store->Stopped());
}

TEST_F(HistoryStoreTest, AFullDiskIsSaidAndOutlived) {
  const auto a = Open("a"), b = Open("b");
  for (int i = 0; i < 40; ++i) Commit(*a, "s" + std::to_string(i));
  Commit(*b, "r1");
  const auto heads = b->Heads();
  // Nothing may grow any more.
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit full{4096, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &full);
  const auto session = Session("r2");
  const auto committed = b->Commit(session, {}, TaskOf(session));
  const auto taken = b->Take(*a->Rows(), kNow);
  const auto asked = b->FindSession("r2");
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(committed.ok());
  EXPECT_THAT(committed.error().message, HasSubstr("b.db"));
  EXPECT_FALSE(taken.ok());
  ASSERT_TRUE(asked.ok());
  EXPECT_FALSE(asked->has_value());
  EXPECT_EQ(b->Heads(), heads);
  Commit(*b, "r2");
  EXPECT_EQ(b->Take(*a->Rows(), kNow)->added, 40);
}

}  // namespace
}  // namespace beckon::intention
