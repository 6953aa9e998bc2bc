// beckon-simulated-decoder: class probabilities of a user without a brain, to try the front end bci
// without a cap.
#include <CLI/CLI.hpp>

#include "services/base/app.h"
#include "services/base/status_reporter.h"
#include "services/ui_bridge/bci/simulated_decoder.h"

namespace {

using namespace beckon;

Status Run(const AppOptions& app, ui_bridge::bci::SimulatedDecoderConfig config,
           const std::string& want) {
  auto table = LoadConfig(app);
  if (!table) return table.error();
  if (auto right = table->Finish(); !right) return right;
  const size_t colon = want.find(':');
  if (colon == std::string::npos || colon == 0 || colon + 1 == want.size())
    return Error{"--want '" + want + "': expected ACTION:CATEGORY, e.g. --want Open:Carton"};
  config.user.action = want.substr(0, colon);
  config.user.category = want.substr(colon + 1);
  if (app.check_config) return {};
  RunLoop loop(/*handle_signals=*/true);
  auto bus = OpenBus(app, "simulated_decoder");
  if (!bus) return bus.error();
  loop.AddFd((*bus)->fd(), [&bus] { (*bus)->HandleReadable(); });
  const SystemClock clock;
  ui_bridge::bci::SimulatedDecoder decoder(config, **bus, loop, clock);
  StatusReporter reporter("simulated_decoder", **bus, loop, [&decoder](msg::Status& status) {
    status.state = std::to_string(decoder.decoded()) + " trials decoded";
  });
  decoder.Begin();
  loop.Run();
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Answers the trials of Beckon's front end bci like a decoder of brain signals.",
               "beckon-simulated-decoder");
  AppOptions common;
  ui_bridge::bci::SimulatedDecoderConfig config;
  std::string want;
  AddAppOptions(app, common);
  app.add_option("--want", want, "What the user wants, e.g. Open:Carton (the nearest carton)")
      ->type_name("ACTION:CATEGORY");
  app.add_option("--truth", config.truth_file,
                 "What stands where, as beckon-capture --truth writes it")
      ->type_name("FILE");
  app.add_option("--accuracy", config.accuracy, "Share of trials whose likeliest class is right")
      ->check(Within(0.02, 0.999))
      ->capture_default_str();
  app.add_option("--sharpness", config.sharpness,
                 "Exponent of the probabilities; above 1: surer than it ought to be")
      ->check(Within(0.01, 100))
      ->capture_default_str();
  app.add_option("--rate", config.rate, "Decodings a second")
      ->check(Within(0.001, 10'000))
      ->capture_default_str();
  app.add_option("--dropout", config.dropout, "Chance that a trial is not decoded")
      ->check(Within(0, 1));
  app.add_option("--duplicate", config.duplicate, "Chance that a decoding is sent twice")
      ->check(Within(0, 1));
  app.add_option("--stop-after", config.stop_after,
                 "Attend to the class STOP from this trial on; 0 = never")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--name", config.name, "Of the decoder")->capture_default_str();
  app.add_option("--device", config.device, "Answer only this front end (default: any)");
  app.add_option("--seed", config.seed, "Of the noise")->capture_default_str();
  return RunApp(app, argc, argv, common, [&] { return Run(common, config, want); });
}
