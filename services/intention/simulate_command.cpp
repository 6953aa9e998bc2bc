#include "services/intention/simulate_command.h"

#include <CLI/CLI.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "services/base/app.h"

namespace beckon::intention {
namespace {

using nlohmann::ordered_json;

std::string Line(const ScenarioSession& session, const Affordances& affordances) {
  const auto name = [&](int category) { return affordances.categories()[category].name; };
  ordered_json line;
  line["user"] = session.user;
  if (session.utime != 0) line["utime"] = session.utime;
  for (const Thing& thing : session.scene) {
    line["scene"].push_back({{"category", name(thing.category)},
                             {"distance_m", thing.distance_m},
                             {"lateral_m", thing.lateral_m}});
  }
  line["want"] = {{"category", name(session.want_category)},
                  {"instance", session.want_rank},
                  {"action", affordances.actions()[session.want_action].name}};
  return line.dump();
}

}  // namespace

CLI::App* AddSimulateCommand(CLI::App& app, SimulateOptions& options) {
  SimulationConfig& simulation = options.simulation;
  std::string kinds = "Habits of the users.";
  for (const SimulatedKind& kind : SimulatedKinds()) {
    kinds += std::string("\n") + kind.name + ": " + kind.habit;
  }
  CLI::App* command = app.add_subcommand("simulate", "Write a scenario of made-up users");
  command->add_option("--kind", simulation.kind, kinds)->required();
  command->add_option("--users", simulation.users, "Number of users")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  command->add_option("--sessions", simulation.sessions, "Sessions of each user")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command
      ->add_option("--repeat", simulation.repeat,
                   "Probability of wanting the same as in the last session, where it is there")
      ->check(Within(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--seed", simulation.seed, "The same seed makes the same users")
      ->capture_default_str();
  command->add_option("--out", options.out, "Where the sessions go, one a line")
      ->type_name("FILE")
      ->required();
  return command;
}

Status WriteSimulated(const SimulateOptions& options, const Affordances& affordances) {
  const auto sessions = Simulate(affordances, options.simulation);
  if (!sessions) return sessions.error();
  std::ofstream out(options.out);
  if (!out) return Error{options.out + ": cannot write the scenario; check --out"};
  for (const ScenarioSession& session : *sessions) out << Line(session, affordances) << '\n';
  out.flush();
  if (!out) return Error{options.out + ": could not be written to the end; is the disk full?"};
  return {};
}

}  // namespace beckon::intention
