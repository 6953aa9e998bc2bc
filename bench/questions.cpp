// How long the next question takes to choose: whole conversations without a history, on tables of
// an everyday size and on the largest. Prints a table and writes JSON.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "services/base/app.h"
#include "services/base/utime.h"
#include "services/intention/affordances_file.h"
#include "services/intention/core/lookahead.h"
#include "services/intention/core/simulated_user.h"

namespace beckon::intention {
namespace {

struct Options {
  std::string affordances = SharedFile("affordances.toml");
  std::string json;
  int sessions = 200;  // of each row
  uint64_t seed = 1;
};

struct Front {
  const char* name;
  Interface interface;
  ErrorRates rates;
};

std::vector<Front> Fronts() {
  const auto with = [](InterfaceKind kind, int options) {
    Interface interface = Interface::YesNo();
    interface.kind = kind;
    interface.max_options = options;
    interface.seconds_per_option = 0.1;
    return interface;
  };
  return {{"yes/no", Interface::YesNo(), {}},
          {"yes/no, 5 % wrong", Interface::YesNo(), {0.05, 0.05}},
          {"choice of 5", with(InterfaceKind::kChoice, 5), {}},
          {"scan of 8, 5 % wrong", with(InterfaceKind::kScan, 8), {0.05, 0.05}},
          {"vector of 36, 5 % wrong", with(InterfaceKind::kVector, 36), {0.05, 0.05}}};
}

/// 60 objects, 300 pairs where categories afford 5 actions at most.
std::vector<Thing> LargeTable(const Affordances& affordances, SeededRandom& random) {
  int most = 0;
  for (size_t i = 0; i < affordances.categories().size(); ++i) {
    if (affordances.categories()[i].actions.size() > affordances.categories()[most].actions.size())
      most = static_cast<int>(i);
  }
  std::vector<Thing> things;
  for (int i = 0; i < 60; ++i)
    things.push_back({most, random.Between(0.2, 1), random.Between(-0.5, 0.5)});
  return things;
}

/// Answers truly, by the mean rates; adds the microseconds of each question.
void Converse(const Situation& situation, const Front& front, SeededRandom& random,
              std::vector<double>& times_us) {
  constexpr double kAccept = 0.995;
  constexpr int kMostQuestions = 100;
  const ErrorModel errors = ErrorModel::Exact(front.rates);
  std::vector<double> posterior;
  for (const Pair& pair : situation.pairs)
    posterior.push_back(std::pow(0.3, std::min(situation.objects[pair.object].rank - 1, 3)));
  const int want = random.Weighted(posterior);
  for (int asked = 0; asked < kMostQuestions; ++asked) {
    const double sum = std::accumulate(posterior.begin(), posterior.end(), 0.0);
    for (double& p : posterior) p /= sum;
    const Stopwatch watch;
    const auto choice = ChooseQuestion(situation, posterior, front.interface, front.rates,
                                       QueryFamilies::kAll, kAccept);
    times_us.push_back(watch.Milliseconds() * 1000);
    if (!choice) return;
    const Question& question = choice->question;
    const int said = question.Meant(situation.pairs[want]);
    for (int i = 0; i < situation.pair_count(); ++i)
      posterior[i] *=
          errors.Probability(0, question.answers(), question.Meant(situation.pairs[i]), said);
    const double left = std::accumulate(posterior.begin(), posterior.end(), 0.0);
    if (question.Accepts(said) == want && posterior[want] >= kAccept * left) return;
  }
}

Status Run(const Options& options) {
  const auto affordances = ReadAffordances(options.affordances);
  if (!affordances) return affordances.error();
  nlohmann::ordered_json rows;
  std::printf("%-26s %-9s %10s %10s %10s %10s\n", "interface", "table", "questions", "p50 us",
              "p95 us", "max us");
  for (const bool large : {false, true}) {
    for (const Front& front : Fronts()) {
      SeededRandom random(options.seed);
      std::vector<double> times_us;
      for (int i = 0; i < options.sessions; ++i) {
        const Situation situation =
            MakeSituation(*affordances, large ? LargeTable(*affordances, random)
                                              : DrawTable(*affordances, random));
        Converse(situation, front, random, times_us);
      }
      std::sort(times_us.begin(), times_us.end());
      const double p50 = times_us[times_us.size() / 2], p95 = times_us[times_us.size() * 95 / 100];
      const char* table = large ? "large" : "everyday";
      std::printf("%-26s %-9s %10zu %10.1f %10.1f %10.1f\n", front.name, table, times_us.size(),
                  p50, p95, times_us.back());
      rows.push_back({{"interface", front.name},
                      {"table", table},
                      {"questions", times_us.size()},
                      {"p50_us", p50},
                      {"p95_us", p95},
                      {"max_us", times_us.back()}});
    }
  }
  if (!options.json.empty())
    std::ofstream(options.json)
        << nlohmann::ordered_json{{"version", VersionString()}, {"rows", rows}}.dump(1) << '\n';
  return {};
}

}  // namespace
}  // namespace beckon::intention

int main(int argc, char** argv) {
  CLI::App app("Times the choice of questions", "beckon-bench-questions");
  beckon::AppOptions common;
  beckon::AddAppOptions(app, common);
  beckon::intention::Options options;
  app.add_option("--affordances", options.affordances, "What can be done with what")
      ->capture_default_str();
  app.add_option("--sessions", options.sessions, "Conversations of each row")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "Of the tables and what is wanted")->capture_default_str();
  app.add_option("--json", options.json, "Write the figures here as well");
  return beckon::RunApp(app, argc, argv, common, [&] { return beckon::intention::Run(options); });
}
