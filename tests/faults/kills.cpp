// SIGKILL of any service at any point of running conversations.
#include <csignal>
#include <iterator>
#include <random>

#include "tests/faults/lab_system.h"

namespace beckon::faults {
namespace {

/// Somewhere in a session: after one to three of its questions, and up to 0.1 s later.
bool WaitForAPoint(LabSystem& system, std::mt19937_64& random) {
  const auto& observer = system.watch().observer();
  const int ended = observer.ended();
  const int questions = observer.questions() + 1 + static_cast<int>(random() % 3);
  const bool reached = system.RunUntil(
      [&] { return observer.questions() >= questions || observer.ended() > ended; });
  system.Run(static_cast<double>(random() % 100) * 1e-3);
  return reached;
}

}  // namespace

Result<Verdict> RunKills(const TrialOptions& options) {
  auto lab = Lab::Make(SeparateHosts(), options.seed);
  if (!lab) return lab.error();
  LabSystem system(**lab, options);
  system.config().think_s = 0.05;
  if (auto started = system.StartServices(); !started) return started.error();
  if (auto started = system.StartUser(); !started) return started.error();
  Verdict verdict;
  std::mt19937_64 random(options.seed);
  std::map<std::string, int> kills;
  int done = 0;
  for (; done < options.n && verdict.holds; ++done) {
    if (!WaitForAPoint(system, random)) {
      verdict.Breach("nothing was asked before kill " + std::to_string(done + 1));
      break;
    }
    const std::string service = kServices[random() % std::size(kServices)];
    // Still down from the kill before: to be killed when it is back.
    system.RunUntil([&] { return system.supervisor().Pid(service).has_value(); });
    const size_t deaths = system.deaths().size();
    system.supervisor().Signal(service, SIGKILL);
    ++kills[service];
    system.RunUntil([&] { return system.deaths().size() > deaths; });
    if (!system.ASessionEnds()) {
      verdict.Breach("no session ended within 30 s of kill " + std::to_string(done + 1) + " (" +
                     service + ")\n" + system.Logs());
    }
  }
  if (verdict.holds && !system.ASessionEnds()) verdict.Breach("no session ended after all kills");
  for (const auto& death : system.deaths()) {
    if (death.exit.signal != SIGKILL)
      verdict.Breach(death.name + " died by itself: " + death.exit.Text() + " " + death.last_line);
  }
  if (system.WrongTasks() > 0)
    verdict.Breach(std::to_string(system.WrongTasks()) + " tasks were not what the user wanted");
  system.CheckDatabase(verdict);
  verdict.details["kills"] = kills;
  if (verdict.holds) {
    verdict.found =
        std::to_string(done) + " kills, " + std::to_string(system.acknowledged().size()) +
        " sessions acknowledged, each once on disk; integrity ok; every dialogue resumed";
  }
  return verdict;
}

}  // namespace beckon::faults
