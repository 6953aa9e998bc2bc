// What beckon-train does: learn a model from a folder of views, or judge one on a folder of views.
#pragma once

#include <functional>
#include <string>

#include "services/base/config.h"
#include "services/perception/train.h"
#include "services/perception/train_report.h"

namespace beckon::perception {

struct TrainOptions {
  std::string data;               // folder to learn from
  std::string test;               // folder to judge on
  std::string model;              // to write with `data`, to read with `test`
  std::string base;               // with `data`: a model to improve by it; empty: learn a new one
  std::string cues;               // with `test`: those that have a say; empty: all
  std::string jsonl;              // a line a view; with `data` of what cross-validation said
  std::string picture;            // confusion matrix, PNG; may be empty
  std::string pictures;           // folder for all pictures; may be empty
  std::string card;               // the model's card; empty: the model's file with .md
  std::string version;            // of the program, for the card
  bool terminal = false;          // standard error is one
  std::function<bool()> stopped;  // whether to leave; empty: never
};

/// [train] of a configuration file over the defaults.
Status LoadTrainConfig(ConfigTable table, TrainConfig& config);

/// Learns, prints what cross-validation over instances says, writes the model and its card.
Status RunTraining(const TrainOptions& options, const TrainConfig& config);

/// Categorises every view, prints accuracy, writes the lines.
Status RunTest(const TrainOptions& options);

/// The pictures that `options` wants.
Status DrawPictures(const TrainOptions& options, const std::vector<Judgement>& judgements,
                    const std::vector<std::string>& categories, float threshold);

}  // namespace beckon::perception
