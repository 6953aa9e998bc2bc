// The five real services, signed, over the hosts of a lab; a simulated user and the robot, which is
// this program.
#pragma once

#include <csignal>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "services/base/run_loop.h"
#include "tests/faults/lab.h"
#include "tests/faults/run_until.h"
#include "tests/faults/trial.h"
#include "tools/beckon/bus_watch.h"
#include "tools/beckon/fleet.h"
#include "tools/beckon/supervisor.h"

namespace beckon::faults {

/// Which host does what.
struct Placement {
  size_t camera = 0;   // capture, perception, pose
  size_t hub = 1;      // intention
  size_t bedside = 2;  // ui_bridge
  size_t robot = 3;
};
/// Hosts of the default placement, each with the roles it needs, and a fifth whose key nobody
/// trusts.
std::vector<HostSpec> SeparateHosts();
inline constexpr size_t kStranger = 4;

class LabSystem {
 public:
  static constexpr int kSceneSeed = 11;
  static constexpr char kAction[] = "Open", kCategory[] = "Carton";

  LabSystem(Lab& lab, const TrialOptions& options, const Placement& placement = {});
  ~LabSystem() { supervisor_.Stop(); }

  tool::FleetConfig& config() { return config_; }
  Status StartServices();
  /// A simulated user who wants one thing over and over.
  Status StartUser();
  /// The page instead, without anybody in front of it.
  Status StartPage();
  void StopUser() { supervisor_.Stop("ui_bridge", SIGTERM, 5000); }

  /// Runs the loop until `condition`; false after `timeout_s`.
  bool RunUntil(const std::function<bool()>& condition, double timeout_s = 30) {
    return faults::RunUntil(loop_, condition, timeout_s);
  }
  void Run(double seconds) {
    RunUntil([] { return false; }, seconds);
  }
  /// Until every service tells how it fares, by a status of after this call.
  bool AllAnswer(double timeout_s = 10);
  /// Until the user ends another session.
  bool ASessionEnds(double timeout_s = 30);

  /// At the robot's host.
  Bus& bus() { return *bus_; }
  RunLoop& loop() { return loop_; }
  tool::Supervisor& supervisor() { return supervisor_; }
  const tool::BusWatch& watch() const { return *watch_; }
  const std::vector<tool::SessionRecord>& sessions() const { return sessions_; }
  const std::vector<tool::Death>& deaths() const { return deaths_; }
  /// A counter of a service's latest status; 0 where it has none.
  int64_t Counter(const std::string& service, const std::string& name) const;
  /// What was promised: sessions of which the robot heard a TASK, or anybody CONFIRMED.
  const std::set<std::string>& acknowledged() const { return acknowledged_; }
  /// Tasks that are not what the user wants, or that no session of the user led to.
  int WrongTasks() const;
  /// The robot's host is cut off: of sessions that began meanwhile it hears the task alone.
  void ExpectUnheardRequests() { hears_all_requests_ = false; }

  /// Ends intention and looks at its file: notes breaches, and how many sessions it holds.
  void CheckDatabase(Verdict& verdict);
  /// The last lines of every log.
  std::string Logs() const;

 private:
  Status Start(size_t host, const tool::ProcessSpec& spec);

  Lab& lab_;
  const Placement placement_;
  RunLoop loop_;
  SystemClock clock_;
  SteadyClock steady_;
  tool::FleetConfig config_;
  std::vector<tool::SessionRecord> sessions_;
  std::vector<tool::Death> deaths_;
  std::set<std::string> acknowledged_, requested_;
  std::map<std::string, msg::Task> tasks_;
  bool hears_all_requests_ = true;
  int contradictions_ = 0;  // tasks of one id that differ
  tool::Supervisor supervisor_;
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<tool::BusWatch> watch_;
};

/// Services that publish a status of their own.
inline constexpr const char* kServices[] = {"capture", "perception", "pose", "intention",
                                            "ui_bridge"};

}  // namespace beckon::faults
