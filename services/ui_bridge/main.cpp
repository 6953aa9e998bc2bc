// beckon-ui-bridge: shows questions to a user and brings the answers back, through one or several
// front ends.
#include <CLI/CLI.hpp>
#include <algorithm>

#include "services/base/app.h"
#include "services/base/status_reporter.h"
#include "services/ui_bridge/service.h"

namespace {

using namespace beckon;

struct Options {
  AppOptions app;
  std::vector<std::string> front_ends{"console"};
  ui_bridge::ServiceConfig service{
      .user = ui_bridge::DefaultUser(), .device = {}, .exit_after_sessions = 0};
};

Status Run(Options& options, std::vector<std::unique_ptr<ui_bridge::FrontEndFactory>>& factories) {
  auto config = LoadConfig(options.app);
  if (!config) return config.error();
  for (auto& factory : factories) factory->Configure(config->Section(factory->name()));
  if (auto right = config->Finish(); !right) return right;
  if (auto right = ui_bridge::ValidateUser(options.service.user); !right)
    return Error{"--user: " + right.error().message};
  if (options.app.check_config) return {};

  RunLoop loop(/*handle_signals=*/true);
  auto bus = OpenBus(options.app, "ui_bridge");
  if (!bus) return bus.error();
  loop.AddFd((*bus)->fd(), [&bus] { (*bus)->HandleReadable(); });
  const SystemClock clock;
  const SteadyClock steady;
  ui_bridge::Service service(options.service, **bus, loop, clock, steady);
  for (const auto& name : options.front_ends) {
    const auto factory =
        std::ranges::find(factories, name, [](const auto& f) { return f->name(); });
    if (auto added = service.Add(**factory); !added) return added;
  }
  StatusReporter reporter("ui_bridge", **bus, loop,
                          [&service](msg::Status& status) { status.state = service.State(); });
  service.Begin();
  loop.Run();
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Shows Beckon's questions to a user and brings the answers back.",
               "beckon-ui-bridge");
  Options options;
  AddAppOptions(app, options.app);
  auto factories = ui_bridge::MakeFrontEndFactories();
  std::vector<std::string> names;
  std::string help = "How the user is asked; may be given several times:";
  for (const auto& factory : factories) {
    names.push_back(factory->name());
    help += "\n  " + factory->name() + ": " + factory->summary();
    factory->AddOptions(app);
  }
  app.add_option("--front-end", options.front_ends, help)
      ->check(CLI::IsMember(names))
      ->type_name("NAME");
  app.add_option("--user", options.service.user, "Whose wishes (default: $USER)")
      ->type_name("NAME");
  app.add_option("--device", options.service.device,
                 "Name of this front end (default: its kind @ this host)")
      ->type_name("NAME");
  app.add_option("--exit-after-sessions", options.service.exit_after_sessions,
                 "Leave after N conversations")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
  return RunApp(app, argc, argv, options.app, [&] { return Run(options, factories); });
}
