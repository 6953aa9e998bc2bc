// The model's card: what it was made of, what it is worth and what it is not good for.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "services/perception/train.h"
#include "services/perception/train_data.h"

namespace beckon::perception {

struct CardSubject {
  std::string model_file;
  std::string data;                            // the folder
  std::vector<ViewRecord> records;             // the views that were used
  std::map<std::string, std::string> skipped;  // file -> why it was left out
  std::string version;                         // of the program
  std::string base;                            // the model that was improved; empty: none
};

/// Markdown. The same training gives the same text.
std::string ModelCard(const CardSubject& subject, const TrainConfig& config,
                      const TrainOutcome& outcome);

}  // namespace beckon::perception
