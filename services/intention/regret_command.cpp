#include "services/intention/regret_command.h"

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "services/intention/core/exact_policy.h"
#include "services/intention/core/lookahead.h"
#include "services/intention/core/simulated_user.h"
#include "services/intention/interface_options.h"

namespace beckon::intention {
namespace {

constexpr double kAcceptPosterior = 0.995;  // without errors any does

enum class Spread { kUniform, kGeometric, kPeaked, kNearest };
struct NamedSpread {
  Spread spread;
  const char* name;
};
constexpr std::array kSpreads = {
    NamedSpread{Spread::kUniform, "uniform"}, NamedSpread{Spread::kGeometric, "geometric"},
    NamedSpread{Spread::kPeaked, "peaked"},   // a few habits over much that is hardly ever wanted
    NamedSpread{Spread::kNearest, "nearest"}  // of a category each is 0.3 times the nearer one
};

std::vector<double> DrawPrior(const Situation& situation, Spread spread, SeededRandom& random) {
  const int n = situation.pair_count();
  std::vector<double> prior(n, 1.0);
  if (spread == Spread::kNearest) {
    for (int i = 0; i < n; ++i)
      prior[i] = std::pow(0.3, situation.objects[situation.pairs[i].object].rank - 1);
  }
  if (spread == Spread::kGeometric) {
    const double ratio = random.Between(0.6, 0.95);
    double weight = 1;
    std::vector<double> left(n, 1.0);
    for (int i = 0; i < n; ++i, weight *= ratio) {
      const int pair = random.Weighted(left);
      left[pair] = 0;
      prior[pair] = weight;
    }
  }
  if (spread == Spread::kPeaked) {
    const double habits = random.Between(0.5, 0.98);
    prior.assign(n, (1 - habits) / n);
    double weight = 1;
    for (int i = 0; i < 4; ++i, weight *= 0.5) prior[random.Below(n)] += habits * weight / 1.875;
  }
  const double sum = std::accumulate(prior.begin(), prior.end(), 0.0);
  for (double& p : prior) p /= sum;
  return prior;
}

/// A few objects, with 9 to kMostExactPairs pairs.
std::vector<Thing> DrawSmallTable(const Affordances& affordances, SeededRandom& random) {
  constexpr int kFewest = 9;
  const int target = kFewest + random.Below(kMostExactPairs - kFewest + 1);
  while (true) {
    std::vector<Thing> things;
    int pairs = 0;
    while (pairs < target) {
      const bool another = !things.empty() && random.Chance(0.3);
      const int category = another
                               ? things[random.Below(static_cast<int>(things.size()))].category
                               : random.Below(static_cast<int>(affordances.categories().size()));
      things.push_back({category, random.Between(0.2, 1), random.Between(-0.5, 0.5)});
      pairs += static_cast<int>(affordances.categories()[category].actions.size());
    }
    if (pairs <= kMostExactPairs) return things;
  }
}

/// Sums over scenes.
struct Row {
  int scenes = 0;
  double pairs = 0;
  double policy = 0;     // seconds
  double questions = 0;  // of the policy
  double best = 0;       // seconds
  double worst = 0;      // regret of a scene, percent

  void Print(const char* spread, const char* queries, const char* against) const {
    std::printf("%-10s %-4s %6.1f %9.3f %9.3f %9.3f  %-5s %7.2f %% %7.2f %%\n", spread, queries,
                pairs / scenes, questions / scenes, policy / scenes, best / scenes, against,
                100 * (policy / best - 1), worst);
  }
};

class Study {
 public:
  Study(const RegretOptions& options, const Affordances& affordances, std::ostream* out)
      : options_(options), affordances_(affordances), out_(out) {}

  void Run() {
    std::printf("%-10s %-4s %6s %9s %9s %9s  %-5s %9s %9s\n", "prior", "ask", "pairs", "questions",
                "seconds", "best", "of", "regret", "worst");
    for (const bool small : {true, false}) {
      for (const QueryFamilies families : {QueryFamilies::kActionObjectFull, QueryFamilies::kAll}) {
        for (const NamedSpread& spread : kSpreads) {
          // The best code says nothing about choices.
          if (small || !options_.interface.Choices()) Measure(small, families, spread);
        }
      }
    }
  }

 private:
  void Measure(bool small, QueryFamilies families, const NamedSpread& spread) {
    const char* queries = families == QueryFamilies::kAll ? "all" : "aof";
    const char* against = small ? "exact" : "code";
    const Interface& interface = options_.interface;
    SeededRandom random(options_.seed);
    Row row;
    for (int i = 0; i < options_.scenes; ++i) {
      const Situation situation =
          MakeSituation(affordances_, small ? DrawSmallTable(affordances_, random)
                                            : DrawTable(affordances_, random));
      const auto prior = DrawPrior(situation, spread.spread, random);
      const PolicyCost cost =
          CostOf(situation, prior, interface, [&](const std::vector<double>& posterior) {
            const auto choice =
                ChooseQuestion(situation, posterior, interface, {}, families, kAcceptPosterior);
            return choice ? std::optional(choice->question) : std::nullopt;
          });
      // A code's word costs what its questions do where yes and no take the same time.
      const double best = small ? BestSeconds(situation, prior, interface, families)
                                : BestCode(prior) * interface.Seconds(2, 0);
      ++row.scenes;
      row.pairs += situation.pair_count();
      row.policy += cost.seconds;
      row.questions += cost.questions;
      row.best += best;
      row.worst = std::max(row.worst, 100 * (cost.seconds / best - 1));
      if (out_ == nullptr) continue;
      *out_ << nlohmann::ordered_json{{"prior", spread.name},
                                      {"queries", queries},
                                      {"pairs", situation.pair_count()},
                                      {"questions", cost.questions},
                                      {"seconds", cost.seconds},
                                      {"best_seconds", best},
                                      {"best_of", against},
                                      {"code_questions", BestCode(prior)}}
                   .dump()
            << '\n';
    }
    row.Print(spread.name, queries, against);
  }

  const RegretOptions& options_;
  const Affordances& affordances_;
  std::ostream* const out_;
};

}  // namespace

CLI::App* AddRegretCommand(CLI::App& app, RegretOptions& options) {
  CLI::App* command = app.add_subcommand(
      "regret", "Compare the default policy with the best possible on random scenes");
  command->add_option("--scenes", options.scenes, "Scenes of each kind")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  command->add_option("--seed", options.seed, "The same seed makes the same scenes")
      ->capture_default_str();
  command->add_option("--jsonl", options.jsonl, "Write a line a scene")->type_name("FILE");
  AddInterfaceOptions(*command, options.interface);
  return command;
}

Status MeasureRegret(const RegretOptions& options, const Affordances& affordances) {
  if (options.jsonl.empty()) {
    Study(options, affordances, nullptr).Run();
    return {};
  }
  std::ofstream out(options.jsonl);
  if (!out) return Error{options.jsonl + ": cannot write the figures; check --jsonl"};
  Study(options, affordances, &out).Run();
  out.flush();
  if (!out) return Error{options.jsonl + ": could not be written to the end; is the disk full?"};
  return {};
}

}  // namespace beckon::intention
