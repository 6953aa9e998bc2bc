// beckon-train: makes the model that perception recognises categories with, and judges it.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <thread>

#include "services/base/app.h"
#include "services/perception/train_program.h"

namespace {

using namespace beckon;
using namespace beckon::perception;

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free, "set by a signal handler");

/// The first signal asks to leave, the second leaves.
void LeaveOnSignals() {
  struct sigaction action {};
  action.sa_handler = [](int) { interrupted = true; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

Status Run(const AppOptions& app_options, TrainOptions& options, TrainConfig& config) {
  Result<ConfigTable> table = LoadConfig(app_options);
  if (!table) return table.error();
  if (Status status = LoadTrainConfig(*table, config); !status) return status;
  if (app_options.check_config) {
    std::puts("configuration ok");
    return {};
  }
  if (options.data.empty() == options.test.empty()) {
    return Error{"expected either --data DIR to learn from or --test DIR to judge on (see --help)"};
  }
  LeaveOnSignals();
  options.stopped = [] { return interrupted.load(); };
  options.terminal = isatty(STDERR_FILENO) != 0;
  options.version = VersionString();
  if (!options.data.empty()) {
    if (options.base == "shipped") options.base = SharedFile("categories.model");
    if (!options.base.empty() && !options.cues.empty()) {
      return Error{"--base keeps the cues of its model: expected no --cues with it"};
    }
    if (!options.cues.empty()) config.cues = options.cues;
    if (options.model.empty()) return Error{"--data needs --model FILE, where to write the model"};
    return RunTraining(options, config);
  }
  if (options.model.empty()) options.model = SharedFile("categories.model");
  return RunTest(options);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Learns object categories from views in folders <Category>/*.pcd, or tests a model on them",
      "beckon-train");
  AppOptions app_options;
  TrainOptions options;
  TrainConfig config;
  config.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  AddAppOptions(app, app_options);
  app.add_option("--data", options.data, "Folder to learn from")->type_name("DIR");
  app.add_option("--test", options.test, "Folder to test on")->type_name("DIR");
  app.add_option("--model", options.model, "Model to write, or to test (default: the shipped one)")
      ->type_name("FILE");
  app.add_option("--jsonl", options.jsonl,
                 "Write a line for each view: with --test what the model says, with --data what "
                 "cross-validation said")
      ->type_name("FILE");
  app.add_option("--base", options.base,
                 "With --data: improve this model by the views, without what it was trained on; "
                 "\"shipped\" is the one that is installed")
      ->type_name("MODEL");
  app.add_option("--cues", options.cues,
                 "Cues the model holds, or with --test those that have a say: all (default), "
                 "dissertation, or names parted by commas")
      ->type_name("NAMES");
  app.add_option("--picture", options.picture, "Draw the confusion matrix")->type_name("PNG");
  app.add_option("--pictures", options.pictures,
                 "Draw confusions.png, risk_coverage.png and reliability.png here")
      ->type_name("DIR");
  app.add_option("--card", options.card,
                 "With --data: what the model is made of and worth, Markdown (default: the model's "
                 "name with .md)")
      ->type_name("FILE");
  app.add_option("--seed", config.seed, "Of everything random in training (default 1)");
  return RunApp(app, argc, argv, app_options, [&] { return Run(app_options, options, config); });
}
