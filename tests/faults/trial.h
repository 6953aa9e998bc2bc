// One row of the table of faults: what is demanded, what was found, and with which seed to find it
// again.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "services/base/result.h"

namespace beckon::faults {

struct TrialOptions {
  int n = 0;  // how much of it: kills, datagrams, runs, ...
  uint64_t seed = 1;
  std::string bin_dir = BECKON_BIN_DIR;  // of the programs
};

struct Verdict {
  bool holds = true;
  std::string found;                                                  // for the table
  nlohmann::ordered_json details = nlohmann::ordered_json::object();  // counts behind it
  /// Notes a breach; the first one is told in the table.
  void Breach(const std::string& what) {
    if (holds) found = what;
    holds = false;
    details["breaches"].push_back(what);
  }
};

/// The error says why the trial could not be made at all.
using Trial = Result<Verdict> (*)(const TrialOptions&);

Result<Verdict> RunKills(const TrialOptions& options);
Result<Verdict> RunForged(const TrialOptions& options);
Result<Verdict> RunMutations(const TrialOptions& options);
Result<Verdict> RunStop(const TrialOptions& options);
Result<Verdict> RunLoss(const TrialOptions& options);
Result<Verdict> RunPartitions(const TrialOptions& options);
Result<Verdict> RunSoak(const TrialOptions& options);
Result<Verdict> RunBadInputs(const TrialOptions& options);

}  // namespace beckon::faults
