#include "services/intention/core/simulated_user.h"

#include <algorithm>
#include <cmath>

namespace beckon::intention {
namespace {

/// One user living: table, time and want of each session from the last ones.
class Life {
 public:
  Life(const Affordances& affordances, const SimulationConfig& config, const SimulatedKind& kind,
       int number)
      : affordances_(affordances),
        config_(config),
        random_(config.seed * 1'000'003 + static_cast<uint64_t>(number)),
        user_(kind.make(affordances, config, random_)) {
    session_.user = config.kind + "-" + std::to_string(config.seed) + "-" + std::to_string(number);
  }

  ScenarioSession Next() {
    session_.scene = user_->NextTable(session_.scene, random_);
    session_.utime = user_->NextTime(random_);
    const Situation table = MakeSituation(affordances_, session_.scene);
    int want = user_->Choose(table, random_);
    if (lived_ > 0 && random_.Chance(config_.repeat)) {
      const int again =
          table.Find(session_.want_category, session_.want_rank, session_.want_action);
      if (again >= 0) want = again;
    }
    const Instance& object = table.objects[table.pairs[want].object];
    session_.want_category = object.category;
    session_.want_rank = object.rank;
    session_.want_action = table.pairs[want].action;
    ++lived_;
    return session_;
  }
  int lived() const { return lived_; }

 private:
  const Affordances& affordances_;
  const SimulationConfig& config_;
  SeededRandom random_;
  const std::unique_ptr<SimulatedUser> user_;
  ScenarioSession session_;  // the last one
  int lived_ = 0;
};

double InMillimetres(double metres) { return std::round(metres * 1000) / 1000; }

}  // namespace

std::vector<Thing> DrawTable(const Affordances& affordances, SeededRandom& random) {
  const int categories = static_cast<int>(affordances.categories().size());
  const double least = TableModel::kFewestPairs * affordances.pair_count();
  const double most = TableModel::kMostPairs * affordances.pair_count();
  while (true) {
    std::vector<Thing> things;
    double pairs = 0;
    for (int category = 0; category < categories; ++category) {
      if (!random.Chance(TableModel::kPresent)) continue;
      for (int n = 0; n < TableModel::kMostOfOne && things.size() < kMaxThings; ++n) {
        Thing& thing = things.emplace_back();
        thing.category = category;
        thing.distance_m =
            InMillimetres(random.Between(TableModel::kNearest_m, TableModel::kFurthest_m));
        thing.lateral_m =
            InMillimetres(random.Between(-TableModel::kMostLateral_m, TableModel::kMostLateral_m));
        pairs += static_cast<double>(affordances.categories()[category].actions.size());
        if (!random.Chance(TableModel::kAnother)) break;
      }
    }
    if (pairs >= least && pairs <= most) return things;
  }
}

Result<std::vector<ScenarioSession>> Simulate(const Affordances& affordances,
                                              const SimulationConfig& config) {
  const auto& kinds = SimulatedKinds();
  const auto kind = std::find_if(kinds.begin(), kinds.end(),
                                 [&](const SimulatedKind& k) { return k.name == config.kind; });
  if (kind == kinds.end()) {
    std::string names;
    for (const SimulatedKind& k : kinds) names += (names.empty() ? "" : ", ") + std::string(k.name);
    return Error{"--kind " + config.kind + ": expected one of " + names};
  }
  std::vector<std::unique_ptr<Life>> lives;
  for (int number = 1; number <= config.users; ++number) {
    lives.push_back(std::make_unique<Life>(affordances, config, *kind, number));
  }
  std::vector<ScenarioSession> sessions;
  SeededRandom turns(config.seed);
  while (!lives.empty()) {
    const int turn = kind->interleaved ? turns.Below(static_cast<int>(lives.size())) : 0;
    sessions.push_back(lives[turn]->Next());
    if (lives[turn]->lived() >= config.sessions) lives.erase(lives.begin() + turn);
  }
  return sessions;
}

}  // namespace beckon::intention
