#include "services/intention/commands.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "services/intention/affordances_file.h"
#include "services/intention/interface_options.h"
#include "services/intention/phrases_file.h"

namespace beckon::intention {

CommandLine::CommandLine(CLI::App& app) {
  flags_.policy.clear();
  flags_.queries.clear();
  AddAppOptions(app, common_);
  app.fallthrough();
  app.add_option("--db", flags_.db, "Database (default: $XDG_DATA_HOME/beckon/beckon.db)")
      ->type_name("FILE");
  app.add_option("--affordances", flags_.affordances,
                 "What can be done with what (default: the one shipped)")
      ->type_name("FILE");
  app.add_option("--phrases", flags_.phrases,
                 "The words of questions (default: the English ones shipped, questions.en.toml)")
      ->type_name("FILE");
  app.add_option("--machine", flags_.machine,
                 "Name of this machine in the history (default: the host name)");
  app.add_option("--policy", flags_.policy,
                 "How to ask: adaptive (default) or oain; evaluate also knows count, "
                 "random, random-scene");
  app.add_option("--queries", flags_.queries,
                 "Questions to ask: all (default), or aof: action, object, full")
      ->check(CLI::IsMember({"aof", "all"}));

  evaluate_command_ =
      app.add_subcommand("evaluate", "Live the sessions of a scenario, without a bus");
  evaluate_command_->add_option("--scenario", evaluate_.scenario, "Sessions, one a line")
      ->type_name("FILE")
      ->required();
  evaluate_command_->add_option("--jsonl", evaluate_.jsonl, "Where the results go")
      ->type_name("FILE")
      ->required();
  evaluate_command_
      ->add_option("--flip", evaluate_.config.flip,
                   "Probability that an answer is not the one that is meant")
      ->check(Within(0.0, 0.5));
  evaluate_command_
      ->add_option("--assume-flip", assume_flip_,
                   "What the policy believes of it (default: with --flip 0 that no "
                   "answer is wrong, else it learns the rate)")
      ->check(Within(0.0, 0.5));
  evaluate_command_->add_option("--lambda", evaluate_.lambda, "Learning rate of oain (default: 1)")
      ->check(Within(0.001, 1000.0));
  evaluate_command_
      ->add_option("--explain", evaluate_.explain,
                   "Tell every session question by question (default: on standard output)")
      ->type_name("FILE")
      ->expected(0, 1)
      ->default_str("-");
  evaluate_command_->add_option("--seed", evaluate_.config.seed, "Of ties and wrong answers");
  AddInterfaceOptions(*evaluate_command_, evaluate_.config.interface);
  simulate_command_ = AddSimulateCommand(app, simulate_);
  regret_command_ = AddRegretCommand(app, regret_);

  history_command_ = app.add_subcommand("history", "Print the sessions of the database");
  history_command_->add_option("--user", history_.user, "Only this user's");
  history_command_->add_flag("--json", history_.json, "A JSON line a session");
  export_command_ = app.add_subcommand("export", "Write the whole history as JSON lines");
  export_command_->add_option("--out", history_.file, "Default: standard output")
      ->type_name("FILE");
  import_command_ =
      app.add_subcommand("import", "Add the rows of an export that are not there yet");
  import_command_->add_option("--in", history_.file, "Default: standard input")->type_name("FILE");
  import_command_->add_option("file", history_.file, "The same")->type_name("FILE");
  forget_command_ = app.add_subcommand("forget", "Forget a user, or the last session");
  forget_command_->add_option("--user", history_.user, "Whom");
  forget_command_->add_flag("--last", history_.last, "Only the last confirmed session");
  app.require_subcommand(0, 1);
}

Result<ServiceConfig> CommandLine::Config() const {
  auto table = LoadConfig(common_);
  if (!table) return table.error();
  auto config = ReadServiceConfig(*table);
  if (!config) return config;
  const auto override_by = [](std::string& value, const std::string& flag) {
    if (!flag.empty()) value = flag;
  };
  override_by(config->db, flags_.db);
  override_by(config->affordances, flags_.affordances);
  override_by(config->phrases, flags_.phrases);
  override_by(config->machine, flags_.machine);
  override_by(config->policy, flags_.policy);
  override_by(config->queries, flags_.queries);
  FillDefaults(*config);
  return config;
}

Status CommandLine::Run() {
  auto config = Config();
  if (!config) return config.error();
  if (common_.check_config) return Check(*config);
  history_.db = config->db;
  if (history_command_->parsed()) return PrintHistory(history_);
  if (export_command_->parsed()) return ExportHistory(history_);
  if (import_command_->parsed())
    return ImportHistory(history_, config->machine, SystemClock().Now());
  if (forget_command_->parsed())
    return ForgetHistory(history_, config->machine, SystemClock().Now());
  if (evaluate_command_->parsed() || simulate_command_->parsed() || regret_command_->parsed()) {
    const auto all = ReadAffordances(config->affordances);
    if (!all) return all.error();
    const Affordances affordances = all->Named();  // as in every published evaluation
    if (simulate_command_->parsed()) return WriteSimulated(simulate_, affordances);
    if (regret_command_->parsed()) return MeasureRegret(regret_, affordances);
    evaluate_.policy = config->policy;
    evaluate_.queries = config->queries;
    if (assume_flip_ >= 0) evaluate_.config.assume_flip = assume_flip_;
    return Evaluate(evaluate_, affordances);
  }
  return Serve(*config);
}

Status CommandLine::Check(const ServiceConfig& config) {
  const auto affordances = ReadAffordances(config.affordances);
  if (!affordances) return affordances.error();
  const auto phrases = ReadPhrases(config.phrases);
  if (!phrases) return phrases.error();
  for (const std::string& missing : MissingWords(*phrases, *affordances))
    std::fprintf(stderr, "warning: %s: %s\n", config.phrases.c_str(), missing.c_str());
  std::printf("configuration, affordances and phrases are right\n");
  return {};
}

Status CommandLine::Serve(const ServiceConfig& config) {
  if (config.policy != "adaptive" && config.policy != "oain") {
    return Error{"--policy " + config.policy + ": expected adaptive or oain"};
  }
  RunLoop loop(/*handle_signals=*/true);
  auto bus = OpenBus(common_, "intention");
  if (!bus) return bus.error();
  const SystemClock clock;
  auto service = Service::Start(config, **bus, loop, clock);
  if (!service) return service.error();
  loop.AddFd((*bus)->fd(), [&] { (*bus)->HandleReadable(); });
  spdlog::info("intention: remembering in {}, policy {}", config.db, config.policy);
  loop.Run();
  return {};
}

}  // namespace beckon::intention
