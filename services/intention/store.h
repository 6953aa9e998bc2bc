// The durable memory: an SQLite file with an append-only history that machines share.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "services/intention/core/history_source.h"
#include "services/intention/core/memory.h"

namespace SQLite {
class Database;
class Statement;
}  // namespace SQLite

namespace beckon::intention {

struct RowHead;

/// What the database has of one origin, for people.
struct OriginSummary {
  std::string origin;
  int64_t rows = 0;
  int64_t sessions = 0;  // as they count: each once, none forgotten
  int64_t erased = 0;
  Utime last_utime = 0;  // hybrid, of the latest row
};

/// WAL with synchronous=FULL: a call that returned successfully survives SIGKILL and a power cut.
/// Use from one thread. Several processes may have the file open; each write waits at most kBusy
/// for another's. "Last", "latest" and "oldest" go by hybrid logical time, not by clocks.
class Store : public Memory, public HistorySource {
 public:
  enum class Mode { kWrite, kRead };
  static constexpr int kBusyMs = 2000;
  /// Bodies are no longer, so that a message can carry any row.
  static constexpr size_t kMostBody = 48 * 1024;
  /// A row that is further ahead of the clock does not move the hybrid time.
  static constexpr Utime kMostAhead = 24 * 3600 * kSecond;

  /// kWrite makes the file and its folder where they are missing and migrates older schemas. Fails
  /// with one line on anything that is not a sound database of this program. `machine`: origin of
  /// the rows written, unless the database knows that it had to leave that name or was copied
  /// from another computer.
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
  Result<std::vector<OriginSummary>> Origins();
  /// Adds the rows that are not there yet, all or none; returns how many. Fails where a row
  /// contradicts one that is there, naming it. `now` stamps the rows that forgetting may need
  /// (see ForgetUser); 0: the latest time in the history.
  Result<int> AddRows(const std::vector<HistoryRow>& rows, Utime now = 0);
  /// Forgets all that this database knows of a user now: from disk too, except the name. Every
  /// machine that hears of it forgets what it knows of the user at that moment, by a row of its
  /// own. Returns the number of sessions.
  Result<int> ForgetUser(const std::string& user, Utime now);
  /// Forgets the last confirmed session (of `user`, or of anybody where that is empty).
  Result<SessionRecord> ForgetLast(const std::string& user, Utime now);
  Result<int64_t> RowCount();

  // HistorySource
  const std::map<std::string, HistoryHead>& Heads() override;
  std::optional<uint64_t> ChainAt(const std::string& origin, int64_t seq) override;
  Result<std::vector<HistoryRow>> RowsAfter(const std::string& origin, int64_t seq, size_t max_rows,
                                            size_t max_bytes) override;
  Result<TakenRows> Take(const std::vector<HistoryRow>& rows, Utime now) override;
  std::string WriteOrigin() override { return origin_; }
  Status LeaveOrigin(const std::string& reason, Utime now) override;
  Status Yield(const std::string& origin, int64_t seq, Utime now) override;

  /// Why this machine does not write under its name; empty: it does.
  const std::string& origin_reason() const { return origin_reason_; }
  /// Looks for rows that another process wrote into the file since Heads was last right.
  Status Refresh();

 private:
  Store(std::string path, std::string machine, std::unique_ptr<SQLite::Database> database);
  /// Runs `work` and turns SQLite's exceptions into an Error.
  template <typename T, typename Work>
  Result<T> Try(Work work);
  /// The statement, ready to be bound; made once. `sql` must be a literal.
  SQLite::Statement& Prepared(const char* sql);

  // store_write.cpp; all inside a transaction.
  /// The row under the next seq; false where its uid is there already.
  bool Insert(const std::string& kind, const RowHead& head, const std::string& body, Utime now);
  int64_t NextSeq(const std::string& origin);
  Utime HybridTime(Utime now);
  void InsertRow(const HistoryRow& row, const RowHead& head);
  bool Has(const std::string& uid);

  // store_identity.cpp
  void ReadIdentity();
  void WriteIdentity(const std::string& origin, const std::string& reason);

  // store_forget.cpp; all inside a transaction.
  /// Stores a row from elsewhere: erased where it was forgotten; a forgetting takes effect.
  void AddForeign(const HistoryRow& row, const RowHead& head, Utime now);
  bool IsForgotten(const HistoryRow& row, const RowHead& head);
  void EraseUid(const std::string& uid);
  void EraseLabelsOf(const std::string& session_id);
  /// Erases what a forget row of `user` names.
  void Obey(const std::string& body, const std::string& user);
  /// Covers, by a row of this machine's own, what a forgetting elsewhere did not know of.
  void Echo(const HistoryRow& forget, const RowHead& head, Utime now);
  /// After a transaction that erased: no copy stays in the write-ahead log.
  void Scrub();

  // store_share.cpp
  void ReadHeads();
  void Advance(const std::string& origin);
  void Extend(const std::string& origin);
  /// Why a row that is to follow its origin's head cannot be taken; empty: it was added.
  std::string TakeOne(const HistoryRow& row, Utime now);
  void MoveRow(const HistoryRow& row, const RowHead& head);

  const std::string path_;
  const std::string machine_;
  std::unique_ptr<SQLite::Database> database_;
  std::map<const char*, std::unique_ptr<SQLite::Statement>> prepared_;
  std::string origin_;
  std::string origin_reason_;
  bool erased_ = false;  // something, since the last Scrub
  bool heads_known_ = false;
  int64_t data_version_ = 0;
  std::map<std::string, HistoryHead> heads_;
  std::map<std::string, std::vector<uint64_t>> chains_;  // by origin and seq - 1
};

}  // namespace beckon::intention
