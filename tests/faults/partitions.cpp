// Three machines, each with an intention service, a history and a clock of its own; the network
// falls apart and heals, services are killed. Afterwards all histories are one.
#include <algorithm>
#include <memory>
#include <random>
#include <set>

#include "tests/faults/room.h"
#include "tests/faults/run_until.h"

namespace beckon::faults {
namespace {

constexpr size_t kMachines = 3;
constexpr Utime kMostSkew = 3600 * kSecond;
constexpr double kMostToConverge_s = 5;

class Rooms {
 public:
  Rooms(Lab& lab, const TrialOptions& options)
      : lab_(lab), options_(options), random_(options.seed) {
    const auto wishes = WishesAtTable();
    for (size_t i = 0; i < kMachines; ++i) {
      std::vector<Person::Wish> here;
      for (const std::string user : {"ann", "ben"}) {
        const auto& [action, category] = wishes[random_() % wishes.size()];
        here.push_back({user, user + "@" + std::to_string(i), action, category});
      }
      rooms_.push_back(std::make_unique<Room>(lab, i, here, loop_));
    }
  }

  Status StartService(size_t i) {
    return rooms_[i]->StartService(options_, Database(i),
                                   static_cast<Utime>(random_() % (2 * kMostSkew)) - kMostSkew);
  }

  /// Cuts, deaths and sessions for some seconds; then everybody falls silent, all services live.
  Status FallApart() {
    GoOn(true);
    for (int cut = 1 + static_cast<int>(random_() % 2); cut > 0; --cut) {
      lab_.relay().Change([](LinkFaults& faults) { faults.CutAtRandom(); });
      Run(0.5 + Chance() * 1.5);
      if (random_() % 2 == 0) {
        const size_t killed = random_() % kMachines;
        rooms_[killed]->KillService();
        ++kills_;
        if (auto started = StartService(killed); !started) return started;
      }
      Run(Chance() * 1.5);
    }
    GoOn(false);
    const auto all_speak = [this] {
      return std::ranges::all_of(rooms_, [](const auto& room) { return room->speaks(); });
    };
    if (!RunUntil(loop_, all_speak, 15)) return Error{"a service does not start: " + LastWords()};
    Run(0.3);  // what was asked for is over
    return {};
  }

  void Heal() {
    lab_.relay().Change([](LinkFaults& faults) { faults.Heal(); });
  }
  bool AllHoldTheSame() const {
    const auto first = RowsOf(Database(0));
    return RowsOf(Database(1)) == first && RowsOf(Database(2)) == first;
  }
  std::set<std::string> Acknowledged() const {
    std::set<std::string> all;
    for (const auto& room : rooms_) all.merge(room->Acknowledged());
    return all;
  }
  std::string Differences() const {
    std::string text;
    for (size_t i = 0; i < kMachines; ++i)
      text += " " + std::to_string(RowsOf(Database(i)).size()) + " rows at machine " +
              std::to_string(i) + ";";
    return text;
  }
  std::string Database(size_t i) const { return lab_.folder(i) + "/history.db"; }
  RunLoop& loop() { return loop_; }
  int kills() const { return kills_; }

 private:
  void GoOn(bool goes_on) {
    for (const auto& room : rooms_) room->GoOn(goes_on);
  }
  void Run(double seconds) {
    RunUntil(
        loop_, [] { return false; }, seconds);
  }
  double Chance() { return static_cast<double>(random_() % 1000) * 1e-3; }
  std::string LastWords() const {
    std::string text;
    for (const auto& room : rooms_) text += room->LastWords() + "; ";
    return text;
  }

  Lab& lab_;
  const TrialOptions options_;
  std::mt19937_64 random_;
  RunLoop loop_;
  int kills_ = 0;
  std::vector<std::unique_ptr<Room>> rooms_;
};

/// One run: apart, healed, the same. Returns how long that took [s].
double JudgeRun(Rooms& rooms, int run, Verdict& verdict) {
  rooms.Heal();
  const Stopwatch watch;
  const bool same = RunUntil(
      rooms.loop(), [&] { return rooms.AllHoldTheSame(); }, 60, kSecond / 20);
  const double seconds = watch.Milliseconds() * 1e-3;
  const std::string in_run = " in run " + std::to_string(run);
  if (!same) {
    verdict.Breach("the histories differ a minute after healing" + in_run + ":" +
                   rooms.Differences());
  } else if (seconds > kMostToConverge_s) {
    verdict.Breach("the histories took " + std::to_string(seconds) + " s to become one" + in_run);
  } else if (const auto missing = MissingIn(rooms.Database(0), rooms.Acknowledged());
             !missing.empty()) {
    verdict.Breach("session " + missing[0] + " was acknowledged and is in no history" + in_run);
  }
  return seconds;
}

}  // namespace

Result<Verdict> RunPartitions(const TrialOptions& options) {
  if (auto there = FakeTimeIsThere(); !there) return there.error();
  std::vector<HostSpec> hosts;
  for (size_t i = 0; i < kMachines; ++i) hosts.push_back({"machine" + std::to_string(i)});
  auto lab = Lab::Make(hosts, options.seed);
  if (!lab) return lab.error();
  Rooms rooms(**lab, options);
  for (size_t i = 0; i < kMachines; ++i)
    if (auto started = rooms.StartService(i); !started) return started.error();
  Verdict verdict;
  std::vector<double> seconds;
  for (int run = 1; run <= options.n && verdict.holds; ++run) {
    if (auto apart = rooms.FallApart(); !apart) return apart.error();
    seconds.push_back(JudgeRun(rooms, run, verdict));
  }
  std::ranges::sort(seconds);
  const double median = seconds[seconds.size() / 2];
  const size_t rows = RowsOf(rooms.Database(0)).size();
  const size_t sessions = rooms.Acknowledged().size();
  verdict.details = {{"runs", seconds.size()},
                     {"rows", rows},
                     {"kills", rooms.kills()},
                     {"sessions_acknowledged", sessions},
                     {"median_s", median},
                     {"most_s", seconds.back()},
                     {"breaches", verdict.details.value("breaches", nlohmann::ordered_json())}};
  if (verdict.holds && sessions == 0) verdict.Breach("no session was had: the trial says nothing");
  if (verdict.holds) {
    char text[240];
    std::snprintf(
        text, sizeof text,
        "%zu runs, %zu sessions, %zu rows, %d kills, clocks up to 1 h off: one history in "
        "all three after %.1f s (median), %.1f s (most); no acknowledged session missing",
        seconds.size(), sessions, rows, rooms.kills(), median, seconds.back());
    verdict.found = text;
  }
  return verdict;
}

}  // namespace beckon::faults
