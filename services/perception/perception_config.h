// The configuration of beckon-perception: what may stand in its TOML file.
#pragma once

#include <optional>
#include <string>

#include "services/base/config.h"
#include "services/perception/perceiver.h"
#include "services/perception/told_store.h"

namespace beckon::perception {

struct PerceptionConfig {
  PerceiverConfig perceiver;
  bool categories = true;    // false: objects stay uncategorised
  std::string model;         // file of beckon-train; empty: the one that ships
  std::string cues = "all";  // of the model's that have a say, as Categoriser::UseCues takes them
  double unknown_prior =
      -1;  // factor on the probability of "Unknown"; negative: as the model has it
  double ask_at_or_below = -1;  // confidence 0..1; negative: as the model has it
  ToldStoreConfig learning;     // no folder: what the user says is remembered in this run alone
};

/// What the command line says over the file.
struct Overrides {
  std::string segmentation;  // empty: as configured
  std::string model;         // the same
  std::string cues;          // the same
  std::string examples;      // the same
  bool no_categories = false;
  int threads = 0;  // 0: as configured
};

/// Reads the whole file; fails on what is wrong or unknown in it.
Result<PerceptionConfig> ReadPerceptionConfig(ConfigTable root, const Overrides& overrides = {});

/// The configured categoriser; nothing where categories are off.
Result<std::optional<Categoriser>> LoadCategoriser(const PerceptionConfig& config);

}  // namespace beckon::perception
