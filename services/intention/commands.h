// The command line of beckon-intention: the service, and the commands that need no bus.
#pragma once

#include "services/base/app.h"
#include "services/intention/history_commands.h"
#include "services/intention/regret_command.h"
#include "services/intention/scenario_file.h"
#include "services/intention/service.h"
#include "services/intention/simulate_command.h"

namespace beckon::intention {

class CommandLine {
 public:
  /// Declares the options and subcommands; `app` must outlive this.
  explicit CommandLine(CLI::App& app);

  AppOptions& common() { return common_; }
  /// Does what the parsed command line says.
  Status Run();

 private:
  Result<ServiceConfig> Config() const;
  static Status Check(const ServiceConfig& config);
  Status Serve(const ServiceConfig& config);

  AppOptions common_;
  ServiceConfig flags_;  // empty texts: not given
  EvaluateOptions evaluate_;
  double assume_flip_ = -1;
  SimulateOptions simulate_;
  RegretOptions regret_;
  HistoryOptions history_;
  CLI::App* evaluate_command_ = nullptr;
  CLI::App* simulate_command_ = nullptr;
  CLI::App* regret_command_ = nullptr;
  CLI::App* history_command_ = nullptr;
  CLI::App* export_command_ = nullptr;
  CLI::App* import_command_ = nullptr;
  CLI::App* forget_command_ = nullptr;
};

}  // namespace beckon::intention
