// One machine with a room around it: a real intention service with a history and a clock of its
// own; table, people and robot are this program's, and share the machine's clock.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "services/base/run_loop.h"
#include "tests/faults/lab.h"
#include "tests/faults/person.h"
#include "tests/faults/trial.h"

namespace beckon::faults {

/// The machine's time, put off.
class SkewedClock : public Clock {
 public:
  Utime skew = 0;
  Utime Now() const override { return clock_.Now() + skew; }

 private:
  SystemClock clock_;
};

/// Why clocks cannot be put off here; nothing where they can.
Status FakeTimeIsThere();

class Room {
 public:
  /// At a host of the lab, with one person a wish, who begin nothing by themselves.
  Room(Lab& lab, size_t host, const std::vector<Person::Wish>& wishes, RunLoop& loop);
  ~Room();
  Room(const Room&) = delete;

  /// Starts (or starts again) its service on `db`, with the room's clock put off by `skew`.
  Status StartService(const TrialOptions& options, const std::string& db, Utime skew = 0);
  /// The service's clock and the room's jump.
  void Jump(Utime skew);
  void KillService();
  /// How it ended; nothing while it runs.
  std::optional<tool::Exit> Ended() { return service_->Poll(); }
  /// Whether it published a status since it was started.
  bool speaks() const { return status_.has_value(); }
  int64_t Counter(const std::string& name) const;
  /// The last line of its log.
  std::string LastWords() const { return tool::LastLine(lab_.folder(host_) + "/intention.log"); }

  void GoOn(bool goes_on);
  /// Sessions of which somebody here heard CONFIRMED, or TASK: once said, they must be on disk.
  std::set<std::string> Acknowledged() const;
  const std::map<std::string, msg::Task>& tasks() const { return tasks_; }

 private:
  void Hear(const msg::Task& task);

  Lab& lab_;
  const size_t host_;
  RunLoop& loop_;
  SteadyClock steady_;
  SkewedClock clock_;
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<Table> table_;
  std::vector<std::unique_ptr<Person>> people_;
  std::map<std::string, msg::Task> tasks_;
  std::optional<tool::ChildProcess> service_;
  std::optional<msg::Status> status_;
};

/// Every row of a history, all of it, as text.
std::set<std::string> RowsOf(const std::string& db);
/// Those of `sessions` that a history has no row of.
std::vector<std::string> MissingIn(const std::string& db, const std::set<std::string>& sessions);

}  // namespace beckon::faults
