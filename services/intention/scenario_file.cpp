#include "services/intention/scenario_file.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "services/intention/session_trace.h"

#include "services/intention/json_lines.h"
#include "services/intention/scenario_line.h"

namespace beckon::intention {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

ordered_json OutputLine(const ScenarioLine& line, const SessionOutcome& outcome, int session,
                        const Affordances& affordances) {
  ordered_json out;
  out["user"] = line.session.user;
  out["session"] = session;
  out["questions"] = outcome.questions;
  out["seconds"] = outcome.seconds;
  out["answered"] = nullptr;
  if (outcome.answered) {
    out["answered"] = {{"category", affordances.categories()[outcome.answered->category].name},
                       {"instance", outcome.answered->rank},
                       {"action", affordances.actions()[outcome.answered->action].name}};
  }
  out["correct"] = outcome.correct;
  out["posterior"] = outcome.posterior;
  out["compute_us"] = outcome.compute_us;
  const json carried = json::parse(line.json);
  for (const auto& [key, value] : carried.items()) {
    if (key != "scene" && key != "want" && !out.contains(key)) out[key] = value;
  }
  return out;
}

double NowMicroseconds() {
  return std::chrono::duration<double, std::micro>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

struct Totals {
  int sessions = 0;
  int64_t questions = 0;
  double seconds = 0;
  int wrong = 0;
  int unanswered = 0;
  double compute_us = 0;

  void Add(const SessionOutcome& outcome) {
    ++sessions;
    questions += outcome.questions;
    seconds += outcome.seconds;
    wrong += outcome.answered && !outcome.correct;
    unanswered += !outcome.answered;
    compute_us += outcome.compute_us;
  }
  void Print() const {
    const double n = std::max(sessions, 1);
    std::printf("sessions %d, mean questions %.3f, ", sessions, static_cast<double>(questions) / n);
    if (seconds != static_cast<double>(questions)) std::printf("mean seconds %.3f, ", seconds / n);
    std::printf("wrong %d, unanswered %d, %.1f us a question\n", wrong, unanswered,
                compute_us / static_cast<double>(std::max<int64_t>(questions, 1)));
  }
};

}  // namespace

Result<std::vector<ScenarioLine>> ReadScenario(const std::string& path,
                                               const Affordances& affordances) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return Error{path + ": cannot read the scenario; check --scenario"};
  std::vector<ScenarioLine> lines;
  JsonLines objects(file, path);
  for (;;) {
    const auto object = objects.Next();
    if (!object) return object.error();
    if (!*object) break;
    auto session = ParseScenarioSession(**object, affordances);
    if (!session) return objects.At(session.error().message);
    lines.push_back({*std::move(session), objects.text()});
  }
  if (lines.empty())
    return Error{path + ": the scenario holds no session, expected one JSON object a line"};
  return lines;
}

Status Evaluate(const EvaluateOptions& options, const Affordances& affordances) {
  const auto families =
      options.queries == "aof" ? QueryFamilies::kActionObjectFull : QueryFamilies::kAll;
  const auto policy = MakePolicy(options.policy, affordances, families, options.lambda);
  if (!policy) return policy.error();
  const auto lines = ReadScenario(options.scenario, affordances);
  if (!lines) return lines.error();
  std::ofstream out(options.jsonl);
  if (!out) return Error{options.jsonl + ": cannot write the result; check --jsonl"};
  std::ofstream explained;
  if (!options.explain.empty() && options.explain != "-") {
    explained.open(options.explain);
    if (!explained) return Error{options.explain + ": cannot be written; check --explain"};
  }
  SessionTrace trace(affordances, options.explain == "-" ? std::cout : explained);
  SessionWatcher* const watcher = options.explain.empty() ? nullptr : &trace;
  Evaluation evaluation(affordances, **policy, options.config, NowMicroseconds);
  std::map<std::string, int> sessions;
  Totals totals;
  for (const ScenarioLine& line : *lines) {
    const SessionOutcome outcome = evaluation.Live(line.session, watcher);
    totals.Add(outcome);
    out << OutputLine(line, outcome, ++sessions[line.session.user], affordances).dump() << '\n';
  }
  out.flush();
  if (!out) return Error{options.jsonl + ": could not be written to the end; is the disk full?"};
  std::cout.flush();
  explained.flush();
  if (!explained) return Error{options.explain + ": could not be written to the end"};
  totals.Print();
  return {};
}

}  // namespace beckon::intention
