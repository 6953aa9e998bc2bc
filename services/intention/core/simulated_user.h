// Made-up users whose habits are known, to measure policies with: each wants something among what a
// random table offers.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "services/base/utime.h"
#include "services/intention/core/evaluation.h"
#include "services/intention/core/seeded_random.h"

namespace beckon::intention {

/// Of which tables are drawn: each category stands on it with kPresent, a further instance of it
/// with kAnother each, at most kMostOfOne; distances and lateral places are uniform. Tables that
/// offer fewer than kFewestPairs or more than kMostPairs pairs (of the dissertation's 36, else in
/// proportion) are drawn again.
struct TableModel {
  static constexpr double kPresent = 0.86;
  static constexpr double kAnother = 0.3;
  static constexpr int kMostOfOne = 5;
  static constexpr double kFewestPairs = 24.0 / 36;
  static constexpr double kMostPairs = 63.0 / 36;
  static constexpr double kNearest_m = 0.2;
  static constexpr double kFurthest_m = 1.0;
  static constexpr double kMostLateral_m = 0.5;
};

std::vector<Thing> DrawTable(const Affordances& affordances, SeededRandom& random);

class SimulatedUser {
 public:
  virtual ~SimulatedUser() = default;

  /// What stands before them in the next session; `last` is what stood there before, empty at
  /// first.
  virtual std::vector<Thing> NextTable(const std::vector<Thing>& last, SeededRandom& random) = 0;
  /// When, in microseconds since the epoch; 0 where it does not matter.
  virtual Utime NextTime(SeededRandom&) { return 0; }
  /// What they want of it: index in table.pairs.
  virtual int Choose(const Situation& table, SeededRandom& random) = 0;
};

struct SimulationConfig {
  std::string kind = "sparse";  // a name of SimulatedKinds()
  int users = 1;
  int sessions = 200;  // of each user
  double repeat = 0;   // P(once more the pair of the last session), where the table has it
  uint64_t seed = 1;
};

struct SimulatedKind {
  const char* name;
  const char* habit;  // one sentence
  bool interleaved;   // whether the users' sessions come mixed, not one user after the other
  std::unique_ptr<SimulatedUser> (*make)(const Affordances&, const SimulationConfig&,
                                         SeededRandom&);
};
const std::vector<SimulatedKind>& SimulatedKinds();

/// Users are called <kind>-<seed>-<number>. Fails on a kind that there is not.
Result<std::vector<ScenarioSession>> Simulate(const Affordances& affordances,
                                              const SimulationConfig& config);

}  // namespace beckon::intention
