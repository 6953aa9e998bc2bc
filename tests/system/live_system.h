// The five real processes on the private bus of this test program, and what a test wants of them.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "services/base/bus.h"
#include "services/base/run_loop.h"
#include "tools/beckon/bus_watch.h"
#include "tools/beckon/fleet.h"
#include "tools/beckon/run_folder.h"
#include "tools/beckon/supervisor.h"

namespace beckon::system_test {

/// The bus that main() entered.
const std::string& LcmUrl();
/// Why there is no such bus; empty where there is.
const std::string& BusObstacle();
/// Why the five processes cannot be tested here; empty where they can.
const std::string& Obstacle();

/// What the embedded scene's simulated user wants in these tests.
inline constexpr int kSeed = 11;
inline constexpr char kWant[] = "Open:Carton";

class LiveSystem {
 public:
  /// With a database of its own, unless `db` names one.
  explicit LiveSystem(const std::string& db = {});
  ~LiveSystem();

  tool::FleetConfig& config() { return config_; }
  /// Capture (unless `with_capture` is false), perception, pose, intention.
  void StartServices(bool with_capture = true);
  /// The simulated user, without end.
  void StartUser(const std::string& want = kWant);
  void Start(const tool::ProcessSpec& spec, tool::Supervisor::Restart restart);

  /// Runs the loop until `condition`; false after `timeout_s`.
  bool RunUntil(const std::function<bool()>& condition, double timeout_s = 30);

  Bus& bus() { return *bus_; }
  tool::Supervisor& supervisor() { return supervisor_; }
  const tool::BusWatch& watch() const { return *watch_; }
  const std::vector<tool::SessionRecord>& sessions() const { return sessions_; }
  const std::vector<tool::Death>& deaths() const { return deaths_; }
  std::string run_dir() const { return folder_->path(); }
  /// The last lines of every log: for a failed test's message.
  std::string Logs() const;

  /// Session ids in the database, each with how often it is there. Ends intention first.
  std::map<std::string, int> SessionsOnDisk();

 private:
  Result<tool::RunFolder> folder_;
  RunLoop loop_;
  SystemClock clock_;
  SteadyClock steady_;
  tool::FleetConfig config_;
  std::vector<tool::SessionRecord> sessions_;
  std::vector<tool::Death> deaths_;
  tool::Supervisor supervisor_;
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<tool::BusWatch> watch_;
};

/// Runs a program to its end; its standard output and error.
struct Output {
  int code = -1;  // -1: killed, or not done in time
  std::string text;
  std::vector<std::string> lines() const;
};
Output RunProgram(const std::string& program, const std::vector<std::string>& args,
                  int timeout_s = 60);

}  // namespace beckon::system_test
