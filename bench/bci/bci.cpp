// Sessions with a simulated decoder of brain signals: how many tasks are wrong, and what a task
// takes. Prints the table and writes the page of docs/experiments/bci.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "bench/bci/person.h"
#include "services/base/app.h"
#include "services/intention/affordances_file.h"
#include "services/intention/core/simulated_user.h"

namespace beckon::bench {
namespace {

using ui_bridge::bci::Control;

struct Options {
  std::string affordances = SharedFile("affordances.toml");
  std::string readme;
  std::string only;
  int users = 100;
  uint64_t seed = 1;
  double threshold = 0, final_threshold = 0;
};

struct Row {
  std::string name;
  PersonConfig config;
  int users_factor = 1;
};

struct Tally {
  int sessions = 0, wrong = 0, abandoned = 0, stopped = 0, too_long = 0;
  double questions = 0, trials = 0, seconds = 0;

  void Add(const Lived& lived) {
    ++sessions;
    wrong += lived.end == Lived::End::kWrong;
    abandoned += lived.end == Lived::End::kAbandoned;
    stopped += lived.end == Lived::End::kStopped;
    too_long += lived.end == Lived::End::kTooLong;
    questions += lived.questions;
    trials += lived.trials;
    seconds += lived.seconds;
  }
};

constexpr int kSessions = 20;
constexpr int kFirst = 5;

PersonConfig Decoder(int classes, double accuracy) {
  PersonConfig config;
  config.accuracy = accuracy;
  auto& layout = config.trials.layout;
  layout.mode = classes == 2 ? msg::StimulusMode::kBinary : msg::StimulusMode::kMatrix;
  layout.rows = layout.columns = classes == 2 ? 1 : static_cast<int>(std::sqrt(classes));
  return config;
}

std::vector<Row> Rows() {
  std::vector<Row> rows;
  for (const int classes : {2, 4, 9}) {
    for (const int percent : {60, 70, 80, 90}) {
      rows.push_back({std::to_string(classes) + " classes, " + std::to_string(percent) + " %",
                      Decoder(classes, percent / 100.0), classes == 4 && percent == 70 ? 2 : 1});
    }
  }
  Row row{"4 classes, 70 %, twice too sure", Decoder(4, 0.7)};
  row.config.sharpness = 2;
  rows.push_back(row);
  row = {"4 classes, 70 %, never calibrated", Decoder(4, 0.7)};
  row.config.learns = false;
  rows.push_back(row);
  row.name = "4 classes, 70 %, twice too sure, never calibrated";
  row.config.sharpness = 2;
  rows.push_back(row);
  row = {"4 classes, 70 %, names a class and no more", Decoder(4, 0.7)};
  row.config.names_only = true;
  rows.push_back(row);
  row = {"4 classes, 70 %, attends to a wrong option in 5 % of questions", Decoder(4, 0.7)};
  row.config.slip = 0.05;
  rows.push_back(row);
  row = {"4 classes, 70 %, thresholds 0.85 and 0.97", Decoder(4, 0.7)};
  row.config.trials.stopping.threshold = 0.85;
  row.config.trials.stopping.final_threshold = 0.97;
  rows.push_back(row);
  row = {"9 classes, 70 %, three of them stop, undo, pause", Decoder(9, 0.7)};
  row.config.trials.layout.controls = {Control::kUndo, Control::kPause, Control::kStop};
  rows.push_back(row);
  return rows;
}

/// Wilson's 95 % interval.
std::pair<double, double> Interval(int hits, int n) {
  constexpr double z = 1.959964;
  const double p = static_cast<double>(hits) / n, d = 1 + z * z / n;
  const double middle = (p + z * z / (2 * n)) / d;
  const double half = z * std::sqrt(p * (1 - p) / n + z * z / (4.0 * n * n)) / d;
  return {std::max(0.0, middle - half), middle + half};
}

std::string Line(const std::string& name, const char* which, const Tally& t) {
  const auto [low, high] = Interval(t.wrong, t.sessions);
  const int done = std::max(1, t.sessions);
  char line[400];
  std::snprintf(line, sizeof line,
                "| %s | %s | %d | %.2f %% (%.2f–%.2f) | %.1f | %.1f | %.0f | %.2f %% | %.2f %% |\n",
                name.c_str(), which, t.sessions, 100.0 * t.wrong / done, 100 * low, 100 * high,
                t.questions / done, t.trials / done, t.seconds / done,
                100.0 * (t.abandoned + t.too_long) / done, 100.0 * t.stopped / done);
  return line;
}

constexpr char kBefore[] =
    "# Tasks by a decoder of brain signals\n\n"
    "Written by `beckon-bench-bci --readme FILE`; the same seed gives the same page.\n\n"
    "Each person lives 20 sessions: a table is drawn, a task is wanted, and intention asks through "
    "the front end\n`bci`, both as they are, on a clock that jumps. The decoder is simulated: the "
    "scores of its classes are normal, that\nof the class attended to higher by as much as its "
    "accuracy takes (of single trials, the likeliest of the named number\nof classes), and it says "
    "Bayes' probabilities of them. A trial takes 3 s, 0.3 s lie between trials, and a question is\n"
    "read for 1.5 s. The front end starts without a calibration and learns one; sessions 1-5 and "
    "6-20 are told apart.\nThe interval is Wilson's.\n\n";

constexpr char kAfter[] =
    "\n- *twice too sure*: probabilities squared and scaled. *Never calibrated*: nothing is "
    "learnt; "
    "the first belief stays.\n"
    "- *names a class*: probability 1 for the likeliest class; how often that is wrong is learnt.\n"
    "- *attends to a wrong option*: in all trials of that question.\n"
    "- *stopped*: by a stop that nobody wanted. *given up*: abandoned by intention, or not done "
    "within an hour.\n"
    "- Trials are drawn independently. Those of a person are not quite: a lapse of attention "
    "lasts, "
    "an electrode dries.\n  Then the same number of trials says less, and real figures are worse "
    "than these; the row of wrong options shows how\n  much is borne.\n"
    "- At chance nearly nothing is to be had: two classes at 60 % carry 0.03 bits a trial, and a "
    "task is worth five.\n";

constexpr char kHead[] =
    "| decoder: classes, accuracy | sessions | n | wrong tasks (95 %) | questions | trials | s | "
    "given up | stopped "
    "|\n"
    "|---|---|---|---|---|---|---|---|---|\n";

Result<std::string> Measure(const intention::Affordances& affordances,
                            const intention::Policy& policy, const Row& row,
                            const Options& options) {
  Tally first, later;
  const int users = options.users * row.users_factor;
  for (int user = 0; user < users; ++user) {
    const uint64_t seed = options.seed * 1'000'003 + static_cast<uint64_t>(user);
    auto sessions = intention::Simulate(
        affordances,
        {.kind = "sparse", .users = 1, .sessions = kSessions, .repeat = 0.3, .seed = seed});
    if (!sessions) return sessions.error();
    PersonConfig config = row.config;
    config.seed = seed;
    if (options.threshold > 0) config.trials.stopping.threshold = options.threshold;
    if (options.final_threshold > 0)
      config.trials.stopping.final_threshold = options.final_threshold;
    Person person(affordances, policy, config);
    for (int i = 0; i < kSessions; ++i)
      (i < kFirst ? first : later).Add(person.Live((*sessions)[static_cast<size_t>(i)]));
  }
  return Line(row.name, "1–5", first) + Line("", "6–20", later);
}

Status Run(const Options& options) {
  auto affordances = intention::ReadAffordances(options.affordances);
  if (!affordances) return affordances.error();
  auto policy = intention::MakePolicy("adaptive", *affordances, intention::QueryFamilies::kAll);
  if (!policy) return policy.error();
  std::string table = kHead;
  std::fputs(kHead, stdout);
  for (const Row& row : Rows()) {
    if (!options.only.empty() && row.name.find(options.only) == std::string::npos) continue;
    auto lines = Measure(*affordances, **policy, row, options);
    if (!lines) return lines.error();
    std::fputs(lines->c_str(), stdout);
    std::fflush(stdout);
    table += *lines;
  }
  if (options.readme.empty()) return {};
  std::ofstream file(options.readme);
  file << kBefore << table << kAfter;
  if (!file.flush()) return Error{options.readme + ": could not be written"};
  return {};
}

}  // namespace
}  // namespace beckon::bench

int main(int argc, char** argv) {
  using namespace beckon;
  CLI::App app("Measures sessions with a simulated decoder of brain signals.", "beckon-bench-bci");
  AppOptions common;
  bench::Options options;
  AddAppOptions(app, common);
  app.add_option("--affordances", options.affordances, "What can be done with what");
  app.add_option("--readme", options.readme, "Write the page there")->type_name("FILE");
  app.add_option("--only", options.only, "Rows whose name contains this")->type_name("TEXT");
  app.add_option("--users", options.users, "Of each row; each lives 20 sessions")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "Of tables, wishes and decodings")->capture_default_str();
  app.add_option("--threshold", options.threshold, "Instead of the default")->check(Within(0.5, 1));
  app.add_option("--final-threshold", options.final_threshold, "Instead of the default")
      ->check(Within(0.5, 1));
  return RunApp(app, argc, argv, common, [&] { return bench::Run(options); });
}
