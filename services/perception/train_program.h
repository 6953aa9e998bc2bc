// What beckon-train does: learn a model from a folder of views, or judge one on a folder of views.
#pragma once

#include <string>

#include "services/base/config.h"
#include "services/perception/train.h"

namespace beckon::perception {

struct TrainOptions {
  std::string data;     // folder to learn from
  std::string test;     // folder to judge on
  std::string model;    // to write with `data`, to read with `test`
  std::string jsonl;    // with `test`: a line a view
  std::string picture;  // confusion matrix, PNG; may be empty
};

/// [train] of a configuration file over the defaults.
Status LoadTrainConfig(ConfigTable table, TrainConfig& config);

/// Learns, prints what cross-validation over instances says, writes the model.
Status RunTraining(const TrainOptions& options, const TrainConfig& config);

/// Categorises every view, prints accuracy, writes the lines.
Status RunTest(const TrainOptions& options);

}  // namespace beckon::perception
