// The durable memory: an SQLite file with an append-only history.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "services/intention/core/memory.h"

namespace SQLite {
class Database;
}

namespace beckon::intention {

/// A row of the history as it is exported, imported and shared.
struct HistoryRow {
  std::string origin;
  int64_t seq = 0;
  std::string kind;
  std::string body;  // JSON
};

/// WAL with synchronous=FULL: a call that returned successfully survives SIGKILL and a power cut.
/// Use from one thread. Several processes may have the file open; each write waits at most kBusy
/// for another's.
class Store : public Memory {
 public:
  enum class Mode { kWrite, kRead };
  static constexpr int kBusyMs = 2000;

  /// kWrite makes the file and its folder where they are missing and migrates older schemas. Fails
  /// with one line on anything that is not a sound database of this program. `machine`: origin of
  /// the rows written.
  static Result<std::unique_ptr<Store>> Open(const std::string& path, const std::string& machine,
                                             Mode mode = Mode::kWrite);
  ~Store() override;

  Result<std::vector<SessionRecord>> SessionsOf(const std::string& user) override;
  Result<std::vector<std::string>> Users() override;
  Result<std::vector<LabelRecord>> LabelsOf(const std::string& source) override;
  Result<std::optional<SessionRecord>> FindSession(const std::string& session_id) override;
  Result<bool> Commit(const SessionRecord& session, const std::vector<LabelRecord>& labels,
                      const msg::Task& task) override;
  Status CommitLabels(const std::vector<LabelRecord>& labels) override;
  Result<std::vector<msg::Task>> OpenTasks() override;
  Status NoteTask(const std::string& task_id, msg::TaskState state, Utime now) override;
  Result<bool> Stopped() override;
  Status SetStopped(bool stopped, Utime now) override;

  /// All users' sessions that are not forgotten, oldest first.
  Result<std::vector<SessionRecord>> AllSessions();
  /// Every row, by origin and seq.
  Result<std::vector<HistoryRow>> Rows();
  /// Adds the rows that are not there yet, all or none; returns how many. Fails where a row
  /// contradicts one that is there, naming it.
  Result<int> AddRows(const std::vector<HistoryRow>& rows);
  /// Forgets all that this database knows of a user now. Returns the number of sessions.
  Result<int> ForgetUser(const std::string& user, Utime now);
  /// Forgets the last confirmed session (of `user`, or of anybody where that is empty).
  Result<SessionRecord> ForgetLast(const std::string& user, Utime now);
  Result<int64_t> RowCount();

 private:
  Store(std::string path, std::string machine, std::unique_ptr<SQLite::Database> database);
  /// Runs `work` and turns SQLite's exceptions into an Error.
  template <typename T, typename Work>
  Result<T> Try(Work work);
  /// Inside a transaction: the row under the next seq; false where its uid is there already.
  bool Insert(const std::string& kind, const std::string& uid, const std::string& user, Utime utime,
              const std::string& body);
  int64_t NextSeq();
  void InsertRow(const HistoryRow& row, const std::string& uid, const std::string& user,
                 Utime utime);
  bool Has(const std::string& uid);

  const std::string path_;
  const std::string machine_;
  std::unique_ptr<SQLite::Database> database_;
};

}  // namespace beckon::intention
