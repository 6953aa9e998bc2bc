#include "services/intention/store.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "services/intention/store_schema.h"
#include "tests/intention/store_records.h"
#include "tests/intention/temporary_folder.h"

namespace beckon::intention {
namespace {

class StoreTest : public testing::Test {
 protected:
  std::unique_ptr<Store> Open(const std::string& file = "",
                              const std::string& machine = "kitchen") {
    auto store = Store::Open(file.empty() ? path : file, machine);
    EXPECT_TRUE(store.ok()) << (store ? "" : store.error().message);
    return store ? *std::move(store) : nullptr;
  }
  std::string Refusal(Store::Mode mode = Store::Mode::kWrite) const {
    const auto store = Store::Open(path, "kitchen", mode);
    return store ? "opened" : store.error().message;
  }
  void Commit(Store& store, const SessionRecord& session) {
    const auto committed = store.Commit(session, {}, TaskOf(session));
    ASSERT_TRUE(committed.ok()) << committed.error().message;
    EXPECT_TRUE(*committed);
  }
  TemporaryFolder folder;
  const std::string path = folder / "sub" / "beckon.db";
};

TEST_F(StoreTest, RemembersOverRestarts) {
  {
    const auto store = Open();
    const auto committed = store->Commit(Session("s1"), {Label("l1")}, TaskOf(Session("s1")));
    ASSERT_TRUE(committed.ok()) << committed.error().message;
    Commit(*store, Session("s2", "bob", 2000));
  }
  const auto store = Open();
  const auto sessions = store->SessionsOf("ann");
  ASSERT_TRUE(sessions.ok());
  ASSERT_EQ(sessions->size(), 1u);
  const SessionRecord& session = sessions->front();
  EXPECT_EQ(session.session_id, "s1");
  EXPECT_EQ(session.category, "Carton");
  EXPECT_EQ(session.device, "switch");
  ASSERT_EQ(session.answers.size(), 2u);
  EXPECT_EQ(session.answers[1].kind, QuestionKind::kFull);
  EXPECT_EQ(session.answers[1].likelihoods, (std::vector<double>{1, 0}));
  EXPECT_EQ(session.answers[1].meant, 0);
  EXPECT_EQ(session.answers[1].device, "speech");
  EXPECT_EQ(session.answers[0].fate, AnswerFate::kWithdrawn);
  EXPECT_EQ(session.answers[1].fate, AnswerFate::kStands);
  EXPECT_EQ(session.present.at("Mug"), 2);
  const auto labels = store->LabelsOf("camera");
  ASSERT_EQ(labels->size(), 1u);
  EXPECT_EQ(labels->front().category, "Tin");
  EXPECT_EQ(labels->front().centroid_W, Eigen::Vector3d(0.1, 0.25, 0.05));
  EXPECT_EQ(labels->front().probabilities[1].probability, 0.25f);
  EXPECT_TRUE(store->LabelsOf("elsewhere")->empty());
  EXPECT_EQ(*store->RowCount(), 3);
}

TEST_F(StoreTest, NamesItsUsersTheLatestFirst) {
  const auto store = Open();
  Commit(*store, Session("s1", "ann", 1000));
  Commit(*store, Session("s2", "bob", 2000));
  Commit(*store, Session("s4", "cy", 2500));
  Commit(*store, Session("s3", "ann", 3000));
  const auto users = store->Users();
  ASSERT_TRUE(users.ok());
  EXPECT_EQ(*users, (std::vector<std::string>{"ann", "cy", "bob"}));
  ASSERT_TRUE(store->ForgetUser("cy", 4000).ok());
  EXPECT_EQ(*store->Users(), (std::vector<std::string>{"ann", "bob"}));
}

TEST_F(StoreTest, DuplicateSessionIsAlreadyThere) {
  const auto store = Open();
  Commit(*store, Session("s1"));
  const auto again = store->Commit(Session("s1", "mallory"), {Label("l9")}, TaskOf(Session("s1")));
  ASSERT_TRUE(again.ok());
  EXPECT_FALSE(*again);
  EXPECT_EQ(*store->RowCount(), 1);
  EXPECT_EQ((*store->FindSession("s1"))->user, "ann");
  EXPECT_FALSE(store->FindSession("s2")->has_value());
}

TEST_F(StoreTest, OpenTasksAreThoseThatNobodyNamed) {
  const auto store = Open();
  Commit(*store, Session("s1"));
  Commit(*store, Session("s2"));
  ASSERT_TRUE(store->NoteTask("s1", msg::TaskState::kAccepted, 5).ok());
  const auto open = store->OpenTasks();
  ASSERT_TRUE(open.ok());
  ASSERT_EQ(open->size(), 1u);
  EXPECT_EQ(open->front().task_id, "s2");
  EXPECT_EQ(open->front().object.category, "Carton");
  EXPECT_EQ(open->front().expires_utime, 1000 + 30 * kSecond);
}

TEST_F(StoreTest, StoppedOutlivesTheProcess) {
  EXPECT_FALSE(*Open()->Stopped());
  ASSERT_TRUE(Open()->SetStopped(true, 1).ok());
  EXPECT_TRUE(*Open()->Stopped());
  ASSERT_TRUE(Open()->SetStopped(false, 1).ok());
  EXPECT_FALSE(*Open()->Stopped());
}

TEST_F(StoreTest, ForgettingIsARowAndHidesWhatWasKnownThen) {
  const auto store = Open();
  Commit(*store, Session("s1", "ann", 1000));
  Commit(*store, Session("s2", "bob", 2000));
  Commit(*store, Session("s3", "ann", 3000));
  const auto last = store->ForgetLast("", 4000);
  ASSERT_TRUE(last.ok());
  EXPECT_EQ(last->session_id, "s3");
  EXPECT_EQ(store->SessionsOf("ann")->size(), 1u);
  EXPECT_EQ(*store->ForgetUser("ann", 5000), 1);
  EXPECT_TRUE(store->SessionsOf("ann")->empty());
  EXPECT_EQ(store->SessionsOf("bob")->size(), 1u);
  EXPECT_TRUE(store->FindSession("s1")->has_value());  // its id stays taken
  Commit(*store, Session("s4", "ann", 500));           // later, whatever its clock says
  EXPECT_EQ(store->SessionsOf("ann")->size(), 1u);
  EXPECT_EQ(*store->RowCount(), 6);
  EXPECT_FALSE(store->ForgetUser("nobody", 1).ok());
}

TEST_F(StoreTest, MergesByUnionInAnyOrder) {
  const auto a = Open(folder / "a.db", "kitchen");
  const auto b = Open(folder / "b.db", "bedroom");
  Commit(*a, Session("s1", "ann", 1000));
  Commit(*b, Session("s2", "ann", 2000));
  ASSERT_TRUE(b->AddRows(*a->Rows()).ok());
  ASSERT_TRUE(b->ForgetLast("ann", 3000).ok());  // s2
  Commit(*a, Session("s3", "ann", 4000));
  EXPECT_EQ(*a->AddRows(*b->Rows()), 2);
  EXPECT_EQ(*a->AddRows(*b->Rows()), 0);
  EXPECT_EQ(*b->AddRows(*a->Rows()), 1);
  const auto rows_a = a->Rows(), rows_b = b->Rows();
  ASSERT_EQ(rows_a->size(), rows_b->size());
  for (size_t i = 0; i < rows_a->size(); ++i) EXPECT_EQ((*rows_a)[i].body, (*rows_b)[i].body);
  EXPECT_EQ(a->SessionsOf("ann")->size(), 2u);
  EXPECT_EQ(b->SessionsOf("ann")->size(), 2u);
}

TEST_F(StoreTest, RefusesRowsThatContradictOrAreNonsense) {
  const auto store = Open();
  Commit(*store, Session("s1"));
  auto rows = *store->Rows();
  rows[0].body.replace(rows[0].body.find("Carton"), 6, "Bottle");
  const auto contradiction = store->AddRows(rows);
  ASSERT_FALSE(contradiction.ok());
  EXPECT_NE(contradiction.error().message.find("row 1 of 'kitchen'"), std::string::npos);
  EXPECT_FALSE(store->AddRows({{"x", 1, "session", "{}"}}).ok());
  EXPECT_FALSE(store->AddRows({{"x", 1, "session", "nonsense"}}).ok());
  EXPECT_FALSE(store->AddRows({{"x", 0, "note", "{}"}}).ok());
  // All or none: the first of these is good.
  EXPECT_FALSE(store->AddRows({{"x", 1, "note", "{}"}, {"x", 2, "session", "{}"}}).ok());
  EXPECT_EQ(*store->RowCount(), 1);
  EXPECT_EQ(*store->AddRows({{"x", 1, "kind of the future", "{}"}}), 1);
}

TEST_F(StoreTest, HistoryIsAppendOnly) {
  Commit(*Open(), Session("s1"));
  SQLite::Database raw(path, SQLite::OPEN_READWRITE);
  EXPECT_THROW(raw.exec("DELETE FROM rows"), SQLite::Exception);
  EXPECT_THROW(raw.exec("UPDATE rows SET user = 'eve'"), SQLite::Exception);
  EXPECT_EQ(
      raw.execAndGet("SELECT n FROM counts WHERE user = 'ann' AND category = 'Carton'").getInt(),
      1);
}

TEST_F(StoreTest, EveryTableIsAppendOnly) {
  const auto store = Open();
  Commit(*store, Session("s1"));
  ASSERT_TRUE(store->NoteTask("s1", msg::TaskState::kDone, 1).ok());
  ASSERT_TRUE(store->SetStopped(true, 1).ok());
  SQLite::Database raw(path, SQLite::OPEN_READWRITE);
  SQLite::Statement tables(raw, "SELECT name FROM sqlite_master WHERE type = 'table'");
  int found = 0;
  while (tables.executeStep()) {
    const std::string name = tables.getColumn(0).getString();
    SCOPED_TRACE(name);
    ++found;
    EXPECT_THROW(raw.exec("DELETE FROM " + name), SQLite::Exception);
    EXPECT_THROW(raw.exec("UPDATE " + name + " SET rowid = rowid"), SQLite::Exception);
  }
  EXPECT_EQ(found, 5);
}

TEST_F(StoreTest, CountsAreViews) {
  const auto store = Open();
  SessionRecord session = Session("s1");
  session.answers = {{QuestionKind::kAction, {0, 1}, 1, "switch"},  // no, rightly
                     {QuestionKind::kAction, {1, 0}, 1, "switch"},  // yes, wrongly
                     {QuestionKind::kAction, {1, 0}, 1, "switch", AnswerFate::kDropped},
                     {QuestionKind::kFull, {0.9, 0.1}, 0, "speech"},
                     {QuestionKind::kFull, {0.5, 0.5}, 0, "speech"},  // undecided: taken as no
                     {QuestionKind::kChoice, {0.2, 0.7, 0.1}, 1, "page"},
                     {QuestionKind::kChoice, {0.4, 0.4, 0.2}, 1, "page"}};  // undecided: none
  Commit(*store, session);
  session.session_id = "s2";
  session.instance = 2;
  session.answers.clear();
  Commit(*store, session);
  Commit(*store, Session("s3"));
  Commit(*store, Session("s4", "bob"));
  SQLite::Database raw(path);
  const auto value = [&](const std::string& sql) { return raw.execAndGet(sql).getInt(); };
  EXPECT_EQ(value("SELECT n FROM counts WHERE user = 'ann' AND instance = 1"), 2);
  EXPECT_EQ(value("SELECT n FROM counts WHERE user = 'ann' AND instance = 2"), 1);
  const std::string ann = " FROM error_counts WHERE user = 'ann' AND device = ";
  EXPECT_EQ(value("SELECT meant_no_said_no" + ann + "'switch'"), 2);
  EXPECT_EQ(value("SELECT meant_no_said_yes" + ann + "'switch'"), 1);
  EXPECT_EQ(value("SELECT meant_yes_said_yes" + ann + "'speech'"), 2);
  EXPECT_EQ(value("SELECT meant_yes_said_no" + ann + "'speech'"), 1);
  EXPECT_EQ(value("SELECT chose_right" + ann + "'page'"), 1);
  EXPECT_EQ(value("SELECT chose_wrong" + ann + "'page'"), 1);
  // As the policies count.
  const auto history = ToHistory(*store->SessionsOf("ann"),
                                 *Affordances::Make({{"Open", "open"}}, {{"Carton", {"Open"}}}));
  AnswerCounts page, speech;
  for (const PastSession& past : history) {
    for (const auto& [device, counts] : past.answers) {
      if (device == "page")
        page.chose_right += counts.chose_right, page.chose_wrong += counts.chose_wrong;
      if (device == "speech") speech.meant_yes_said_no += counts.meant_yes_said_no;
    }
  }
  EXPECT_EQ(page.chose_right, 1);
  EXPECT_EQ(page.chose_wrong, 1);
  EXPECT_EQ(speech.meant_yes_said_no, 1);
}

TEST_F(StoreTest, RefusesRowsOfAbsurdValues) {
  const auto store = Open();
  Commit(*store, Session("s1"));
  const std::string good = store->Rows()->front().body;
  for (const auto& [from, to] : std::map<std::string, std::string>{
           {"\"instance\":1", "\"instance\":1000000000"},
           {"\"questions\":2", "\"questions\":-1"},
           {"\"utime\":1000", "\"utime\":1e300"},
           {"\"Mug\":2", "\"Mug\":-2"},
           {"\"meant\":1", "\"meant\":2"},
           {"\"likelihoods\":[0.0,1.0]", "\"likelihoods\":[0.0,-1.0]"},
           {"\"likelihoods\":[0.0,1.0]", "\"likelihoods\":[1.0]"},
           {"\"session_id\":\"s1\"", "\"session_id\":7"}}) {
    std::string body = good;
    ASSERT_NE(body.find(from), std::string::npos) << from << " in " << body;
    body.replace(body.find(from), from.size(), to);
    EXPECT_FALSE(store->AddRows({{"x", 1, "session", body}}).ok()) << to;
  }
  EXPECT_EQ(*store->RowCount(), 1);
}

TEST_F(StoreTest, MergedBothWaysTwoDatabasesAreEqual) {
  const auto a = Open(folder / "a.db", "kitchen");
  const auto b = Open(folder / "b.db", "bedroom");
  for (int i = 0; i < 20; ++i) {
    Store& store = i % 3 == 0 ? *b : *a;
    const std::string user = i % 2 == 0 ? "ann" : "bob";
    Commit(store, Session("s" + std::to_string(i), user, 1000 * (20 - i)));
    if (i == 9) {
      ASSERT_TRUE(b->AddRows(*a->Rows()).ok());
      ASSERT_TRUE(b->ForgetUser("ann", 5).ok());
    }
    if (i == 14) {
      ASSERT_TRUE(a->ForgetLast("bob", 6).ok());
    }
  }
  ASSERT_TRUE(a->AddRows(*b->Rows()).ok());
  ASSERT_TRUE(b->AddRows(*a->Rows()).ok());
  const auto content = [](Store& store) {
    std::string text;
    const auto rows = *store.Rows();
    for (const HistoryRow& row : rows)
      text += row.origin + " " + std::to_string(row.seq) + " " + row.kind + " " + row.body + "\n";
    text += "--\n";
    const auto sessions = *store.AllSessions();
    for (const SessionRecord& session : sessions) text += session.session_id + "\n";
    return text;
  };
  EXPECT_EQ(content(*a), content(*b));
  EXPECT_EQ(*a->AddRows(*b->Rows()), 0);
}

TEST_F(StoreTest, LosesNothingItAcknowledgedWhenKilled) {
  // Each child commits until it is killed, and says on a pipe what it was promised.
  std::set<std::string> acknowledged;
  for (int round = 0; round < 6; ++round) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
      const auto store = Store::Open(path, "kitchen");
      for (int i = 0; store && i < 100'000; ++i) {
        const std::string id = "r" + std::to_string(round) + "-" + std::to_string(i);
        const auto committed = (*store)->Commit(Session(id), {}, TaskOf(Session(id)));
        if (!committed || !*committed) _exit(1);
        if (write(ends[1], (id + "\n").c_str(), id.size() + 1) < 0) _exit(1);
      }
      _exit(1);
    }
    close(ends[1]);
    std::string heard;
    char buffer[256];
    while (std::count(heard.begin(), heard.end(), '\n') < 15 + 7 * round) {
      const auto got = read(ends[0], buffer, sizeof buffer);
      ASSERT_GT(got, 0) << "the child ended by itself";
      heard.append(buffer, static_cast<size_t>(got));
    }
    kill(child, SIGKILL);
    for (ssize_t got; (got = read(ends[0], buffer, sizeof buffer)) > 0;)
      heard.append(buffer, static_cast<size_t>(got));
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    std::istringstream lines(heard.substr(0, heard.rfind('\n') + 1));
    for (std::string line; std::getline(lines, line);) acknowledged.insert(line);
  }
  const auto store = Open();
  const auto rows = store->Rows();
  ASSERT_TRUE(rows.ok());
  for (const std::string& id : acknowledged) EXPECT_TRUE(store->FindSession(id)->has_value()) << id;
  // At most one a round was committed and not acknowledged; numbers have no gap.
  EXPECT_LE(rows->size(), acknowledged.size() + 6);
  for (size_t i = 0; i < rows->size(); ++i) EXPECT_EQ((*rows)[i].seq, static_cast<int64_t>(i) + 1);
  SQLite::Database raw(path);
  EXPECT_EQ(raw.execAndGet("PRAGMA integrity_check").getString(), "ok");
}

TEST_F(StoreTest, SaysThatItIsLocked) {
  Open();
  SQLite::Database other(path, SQLite::OPEN_READWRITE);
  other.exec("BEGIN EXCLUSIVE");
  EXPECT_NE(Refusal().find("locked by another process"), std::string::npos);
}

/// What `work` returns when it runs without root's rights.
template <typename Work>
std::string Unprivileged(Work work) {
  int ends[2];
  EXPECT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    if (geteuid() == 0 && setuid(65534) != 0) _exit(1);
    const std::string text = work();
    _exit(write(ends[1], text.data(), text.size()) < 0);
  }
  close(ends[1]);
  char buffer[1000];
  std::string text;
  for (ssize_t got; (got = read(ends[0], buffer, sizeof buffer)) > 0;) {
    text.append(buffer, static_cast<size_t>(got));
  }
  close(ends[0]);
  waitpid(child, nullptr, 0);
  return text;
}

TEST_F(StoreTest, SaysThatItIsReadOnly) {
  Commit(*Open(), Session("s1"));
  chmod((folder / "").c_str(), 0755);
  chmod((folder / "sub").c_str(), 0777);
  chmod(path.c_str(), 0444);
  EXPECT_NE(Unprivileged([&] { return Refusal(); }).find("database is read-only"),
            std::string::npos);
  chmod(path.c_str(), 0666);
  chmod((folder / "sub").c_str(), 0555);
  EXPECT_NE(Unprivileged([&] { return Refusal(); }).find("folder is read-only"), std::string::npos);
  EXPECT_EQ(Unprivileged([&] { return Refusal(Store::Mode::kRead); }), "opened");
  chmod(path.c_str(), 0000);
  EXPECT_NE(Unprivileged([&] { return Refusal(Store::Mode::kRead); }).find("cannot read"),
            std::string::npos);
  chmod((folder / "sub").c_str(), 0755);
}

TEST_F(StoreTest, SaysThatItIsNotADatabase) {
  std::filesystem::create_directories(folder / "sub");
  std::ofstream(path) << std::string(5000, 'x');
  EXPECT_NE(Refusal().find("is not a database"), std::string::npos);
  EXPECT_NE(Refusal(Store::Mode::kRead).find("is not a database"), std::string::npos);
  std::filesystem::remove(path);
  std::filesystem::create_directory(path);
  EXPECT_NE(Refusal().find("is a folder"), std::string::npos);
  EXPECT_NE(Refusal(Store::Mode::kRead).find("is a folder"), std::string::npos);
}

TEST_F(StoreTest, LeavesOtherProgramsDatabasesAlone) {
  std::filesystem::create_directories(folder / "sub");
  {
    SQLite::Database other(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    other.exec("CREATE TABLE recipes (name TEXT)");
  }
  EXPECT_NE(Refusal().find("of another program"), std::string::npos);
}

TEST_F(StoreTest, SaysThatItIsNewer) {
  Open();
  SQLite::Database(path, SQLite::OPEN_READWRITE).exec("PRAGMA user_version = 99");
  EXPECT_NE(Refusal().find("newer version (schema 99"), std::string::npos);
  EXPECT_NE(Refusal(Store::Mode::kRead).find("newer version"), std::string::npos);
}

TEST_F(StoreTest, SaysThatItIsDamaged) {
  {
    const auto store = Open();
    for (int i = 0; i < 60; ++i) Commit(*store, Session("s" + std::to_string(i)));
  }
  const auto size = std::filesystem::file_size(path);
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(8192);
  file << std::string(size - 8192, '\x5a');
  file.close();
  EXPECT_NE(Refusal().find("damaged"), std::string::npos);
}

TEST_F(StoreTest, FindsEveryDamagedTreeWhenItOpens) {
  {
    const auto store = Open();
    for (int i = 0; i < 60; ++i) Commit(*store, Session("s" + std::to_string(i)));
    ASSERT_TRUE(store->NoteTask("s1", msg::TaskState::kDone, 1).ok());
    ASSERT_TRUE(store->SetStopped(false, 1).ok());
  }
  std::map<std::string, int64_t> roots;
  int64_t page_bytes = 0;
  {
    SQLite::Database raw(path);
    page_bytes = raw.execAndGet("PRAGMA page_size").getInt64();
    SQLite::Statement query(raw, "SELECT name, rootpage FROM sqlite_master WHERE rootpage > 0");
    while (query.executeStep())
      roots[query.getColumn(0).getString()] = query.getColumn(1).getInt64();
  }
  for (const char* table : {"rows", "tasks", "task_states", "stops"})
    ASSERT_TRUE(roots.contains(table)) << table;
  std::ifstream whole(path, std::ios::binary);
  const std::string sound((std::istreambuf_iterator<char>(whole)), {});
  for (const auto& [name, page] : roots) {
    SCOPED_TRACE(name);
    std::string damaged = sound;
    damaged.replace(static_cast<size_t>((page - 1) * page_bytes), static_cast<size_t>(page_bytes),
                    std::string(static_cast<size_t>(page_bytes), '\x5a'));
    std::ofstream(path, std::ios::binary) << damaged;
    for (const auto mode : {Store::Mode::kWrite, Store::Mode::kRead}) {
      const std::string refusal = Refusal(mode);
      EXPECT_EQ(refusal.find(path + ": the database is damaged ("), 0u) << refusal;
      EXPECT_NE(refusal.find("import a backup"), std::string::npos) << refusal;
    }
  }
  std::ofstream(path, std::ios::binary) << sound;
  EXPECT_EQ(Open()->SessionsOf("ann")->size(), 60u);
}

TEST_F(StoreTest, FindsALeafPageThatWasOverwritten) {
  {
    const auto store = Open();
    for (int i = 0; i < 60; ++i) Commit(*store, Session("s" + std::to_string(i)));
  }
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  const std::string sound((std::istreambuf_iterator<char>(file)), {});
  const size_t body = sound.rfind("\"session_id\":\"s30\"");
  ASSERT_NE(body, std::string::npos);
  const size_t page_start = body / 4096 * 4096;
  file.clear();
  file.seekp(static_cast<std::streamoff>(page_start));
  file << std::string(4096, '\0');
  file.close();
  const std::string refusal = Refusal();
  EXPECT_NE(refusal.find("the database is damaged ("), std::string::npos) << refusal;
}

TEST_F(StoreTest, OpensTheFilesOfTheFirstVersion) {
  // Written as version 1 wrote it; keep this text as it is.
  std::filesystem::create_directories(folder / "sub");
  {
    SQLite::Database old(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    old.exec(R"sql(
      CREATE TABLE rows (origin TEXT NOT NULL, seq INTEGER NOT NULL, kind TEXT NOT NULL,
        uid TEXT NOT NULL UNIQUE, user TEXT NOT NULL, utime INTEGER NOT NULL,
        body TEXT NOT NULL CHECK (json_valid(body)), PRIMARY KEY (origin, seq));
      CREATE TABLE tasks (task_id TEXT PRIMARY KEY, encoded BLOB NOT NULL);
      CREATE TABLE task_states (task_id TEXT NOT NULL, state INTEGER NOT NULL, utime INTEGER NOT NULL);
      INSERT INTO rows VALUES ('attic', 1, 'session', 'session/old', 'ann', 5,
        '{"session_id":"old","user":"ann","device":"console","utime":5,"category":"Mug","action":"Drink","instance":1,"questions":4,"posterior":1.0,"answers":[]}');
      PRAGMA application_id = 1111706446;
      PRAGMA user_version = 1;
    )sql");
  }
  EXPECT_NE(Refusal(Store::Mode::kRead).find("older version"), std::string::npos);
  const auto store = Open();
  ASSERT_EQ(store->SessionsOf("ann")->size(), 1u);
  EXPECT_EQ(store->SessionsOf("ann")->front().action, "Drink");
  EXPECT_FALSE(*store->Stopped());
  EXPECT_EQ(SQLite::Database(path).execAndGet("PRAGMA user_version").getInt(), kSchemaVersion);
}

TEST_F(StoreTest, OpensTheFilesOfTheSecondVersion) {
  // Written as version 2 wrote it, with answers of its form and of the next; keep this text as it
  // is.
  std::filesystem::create_directories(folder / "sub");
  {
    SQLite::Database old(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    old.exec(R"sql(
      CREATE TABLE rows (origin TEXT NOT NULL, seq INTEGER NOT NULL, kind TEXT NOT NULL,
        uid TEXT NOT NULL UNIQUE, user TEXT NOT NULL, utime INTEGER NOT NULL,
        body TEXT NOT NULL CHECK (json_valid(body)), PRIMARY KEY (origin, seq));
      CREATE TABLE tasks (task_id TEXT PRIMARY KEY, encoded BLOB NOT NULL);
      CREATE TABLE task_states (task_id TEXT NOT NULL, state INTEGER NOT NULL, utime INTEGER NOT NULL);
      CREATE TABLE stops (utime INTEGER NOT NULL, stopped INTEGER NOT NULL);
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
      CREATE VIEW counts AS SELECT user, category, action, COUNT(*) AS n FROM sessions GROUP BY user, category, action;
      INSERT INTO rows VALUES ('attic', 1, 'session', 'session/old', 'ann', 5,
        '{"session_id":"old","user":"ann","device":"console","utime":5,"category":"Mug","action":"Drink","instance":1,"questions":4,"posterior":1.0,"answers":[{"kind":"action","yes":1.0,"no":0.0,"meant_yes":true},{"kind":"object","yes":1.0,"no":0.0,"meant_yes":false},{"kind":"set","yes":0.0,"no":1.0,"meant_yes":false},{"kind":"full","yes":1.0,"no":0.0,"meant_yes":true}]}');
      INSERT INTO rows VALUES ('attic', 2, 'session', 'session/newer', 'ann', 6,
        '{"session_id":"newer","user":"ann","device":"console","utime":6,"category":"Mug","action":"Drink","instance":1,"questions":1,"posterior":1.0,"present":{"Mug":2},"answers":[{"kind":"full","likelihoods":[1.0,0.0],"meant":0,"device":"console"}]}');
      INSERT INTO stops VALUES (7, 1);
      PRAGMA application_id = 1111706446;
      PRAGMA user_version = 2;
    )sql");
  }
  EXPECT_NE(Refusal(Store::Mode::kRead).find("older version"), std::string::npos);
  const auto store = Open();
  const auto sessions = store->SessionsOf("ann");
  ASSERT_EQ(sessions->size(), 2u);
  ASSERT_EQ(sessions->front().answers.size(), 4u);
  EXPECT_EQ(sessions->front().answers[1].meant, 1);
  EXPECT_EQ(sessions->front().answers[1].device, "console");
  EXPECT_TRUE(*store->Stopped());
  SQLite::Database raw(path);
  const auto value = [&](const std::string& column) {
    return raw.execAndGet("SELECT " + column + " FROM error_counts WHERE user = 'ann'").getInt();
  };
  EXPECT_EQ(value("meant_yes_said_yes"), 3);
  EXPECT_EQ(value("meant_no_said_yes"), 1);
  EXPECT_EQ(value("meant_no_said_no"), 1);
  EXPECT_EQ(value("meant_yes_said_no"), 0);
  EXPECT_EQ(raw.execAndGet("SELECT n FROM counts WHERE instance = 1").getInt(), 2);
  EXPECT_EQ(raw.execAndGet("PRAGMA user_version").getInt(), kSchemaVersion);
}

TEST_F(StoreTest, WritesDurably) {
  Open();
  SQLite::Database raw(path);
  EXPECT_EQ(raw.execAndGet("PRAGMA journal_mode").getString(), "wal");
}

}  // namespace
}  // namespace beckon::intention
