// beckon-train: makes the model that perception recognises categories with, and judges it.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "services/base/app.h"
#include "services/perception/train_program.h"

namespace {

using namespace beckon;
using namespace beckon::perception;

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
  if (!options.data.empty()) {
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
  AddAppOptions(app, app_options);
  app.add_option("--data", options.data, "Folder to learn from")->type_name("DIR");
  app.add_option("--test", options.test, "Folder to test on")->type_name("DIR");
  app.add_option("--model", options.model, "Model to write, or to test (default: the shipped one)")
      ->type_name("FILE");
  app.add_option("--jsonl", options.jsonl, "With --test: write a line for each view")
      ->type_name("FILE");
  app.add_option("--picture", options.picture, "Draw the confusion matrix")->type_name("PNG");
  app.add_option("--seed", config.seed, "Of everything random in training (default 1)");
  return RunApp(app, argc, argv, app_options, [&] { return Run(app_options, options, config); });
}
