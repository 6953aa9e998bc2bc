// How the histories of several machines become one: the protocol without a network, a database or
// a clock (docs/history-sharing.md).
#pragma once

#include <map>
#include <random>
#include <string>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/intention/core/history_source.h"

namespace beckon::intention {

/// Two clocks at one moment [us].
struct Instant {
  Utime steady = 0;  // paces
  Utime wall = 0;    // stamps; may be wrong and may jump
};

struct HistorySyncConfig {
  std::string run;  // random, of this run of the process
  uint64_t seed = 0;
  Utime digest_period = 1'500'000;  // us between digests where nothing happens
  double quiet_bytes_per_s = 700;   // digests of very many origins come more rarely
  int burst_messages = 4;           // sent on one request
  size_t message_bytes = 56'000;    // of rows and digests in one message
};

struct HistorySyncCounters {
  int64_t rows_sent = 0;
  int64_t rows_received = 0;  // that were new
  int64_t rows_again = 0;     // that were there already
  int64_t rows_early = 0;     // that followed a gap: they are asked for again
  int64_t far_future = 0;     // whose time is more than a day ahead
  int64_t yielded = 0;        // forks in which this machine's rows moved to another origin
  int64_t errors = 0;         // of the memory: full, locked, damaged
  std::map<std::string, int64_t> refused;  // rows, by reason
};

/// One machine's part. Use from one thread; the steady clock must not go back.
class HistorySync {
 public:
  /// `source` must outlive this.
  HistorySync(HistorySource& source, HistorySyncConfig config);

  /// Both return what is to be sent now; their seal is empty.
  std::vector<msg::History> OnMessage(const msg::History& message, const Instant& now);
  /// Call every 10 to 50 ms.
  std::vector<msg::History> Tick(const Instant& now);

  const HistorySyncCounters& counters() const { return counters_; }
  /// Rows that others said to have and that are not here yet.
  int64_t BehindBy() const;
  /// When each other machine was heard last [us, steady].
  const std::map<std::string, Utime>& peers() const { return peers_; }
  /// The last error of the memory; empty: none since the last success.
  const std::string& trouble() const { return trouble_; }

 private:
  struct Want {
    int64_t seq = 0;   // the highest that somebody has
    Utime told = 0;    // last, by somebody
    Utime ask_at = 0;  // next
    int tries = 0;     // since the last progress
  };
  struct Answer {
    int64_t after = 0;
    Utime due = 0;
  };
  /// The last rows of an origin on the bus, whoever sent them.
  struct Stream {
    int64_t upto = 0;
    Utime at = 0;
    bool mine = false;
  };
  struct Probed {
    int64_t width = 0;
    Utime at = 0;
  };
  /// Messages with rows, in the making.
  struct Burst {
    std::vector<msg::History> messages;
    size_t room = 0;  // bytes, in the last one
  };
  using Entries = std::map<int64_t, uint64_t>;  // checksum by seq, of one origin

  void TakeRows(const msg::History& message, const std::map<std::string, Entries>& entries,
                const Instant& now);
  void ReadDigests(const msg::History& message, const std::map<std::string, Entries>& entries,
                   const Instant& now);
  void ReadEntries(const std::string& origin, const Entries& entries, bool request,
                   const Instant& now);
  void Settle(const std::string& origin, const Entries& entries, const Instant& now);
  void Probe(const std::string& origin, int64_t low, int64_t high, Utime now);
  void Wanted(const std::string& origin, int64_t seq, bool ask_now, Utime now);
  void AnswerLater(const std::string& origin, int64_t after, Utime now);
  void LeaveIfOwn(const std::string& origin, const char* reason, const Instant& now);

  std::vector<msg::History> Flush(const Instant& now);
  void PushOwn(Utime now);
  void SendAnswers(std::vector<msg::History>& out, const Instant& now);
  int64_t AddRows(Burst& burst, const std::string& origin, int64_t after, const Instant& now);
  void SendRequest(std::vector<msg::History>& out, const Instant& now);
  void SendDigest(std::vector<msg::History>& out, const Instant& now);
  msg::History Message(const Instant& now);
  void AddEntry(msg::History& message, const std::string& origin, int64_t seq);
  HistoryHead HeadOf(const std::string& origin);
  bool Note(const Status& status);
  Utime Jitter(Utime most);

  HistorySource& source_;
  const HistorySyncConfig config_;
  std::mt19937_64 random_;
  HistorySyncCounters counters_;
  std::string trouble_;
  std::map<std::string, Utime> peers_;
  std::map<std::string, Want> wants_;
  std::map<std::string, Answer> answers_;
  std::map<std::string, Stream> streams_;
  std::map<std::string, Probed> probed_;
  std::vector<std::pair<std::string, int64_t>> probes_;  // entries to send
  Utime next_digest_ = 0;
  std::string digest_cursor_;  // the last origin named by a digest that is not complete
  std::string pushed_origin_;
  int64_t pushed_seq_ = 0;
};

}  // namespace beckon::intention
