#include "services/intention/scenario_file.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

namespace beckon::intention {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

/// A key of an object that must be there; throws what is wrong, in words.
const json& Need(const json& object, const char* key) {
  if (!object.is_object()) throw std::string("expected an object with '") + key + "'";
  const auto found = object.find(key);
  if (found == object.end()) throw std::string("'") + key + "' is missing";
  return *found;
}

double NeedNumber(const json& object, const char* key) {
  const json& value = Need(object, key);
  if (!value.is_number() || !std::isfinite(value.get<double>())) {
    throw std::string("'") + key + "' must be a finite number";
  }
  return value.get<double>();
}

std::string NeedText(const json& object, const char* key) {
  const json& value = Need(object, key);
  if (!value.is_string()) throw std::string("'") + key + "' must be a text";
  return value.get<std::string>();
}

Utime NeedUtime(const json& object) {
  const json& value = Need(object, "utime");
  if (!value.is_number_integer() || value < 0) {
    throw std::string("'utime' must be a whole number of microseconds since the epoch");
  }
  return value.get<Utime>();
}

int NeedCategory(const json& object, const Affordances& affordances) {
  const std::string name = NeedText(object, "category");
  const int category = affordances.FindCategory(name);
  if (category < 0) throw "unknown category '" + name + "', expected one of the affordances file";
  return category;
}

Thing ParseThing(const json& object, const Affordances& affordances) {
  Thing thing;
  thing.category = NeedCategory(object, affordances);
  thing.distance_m = NeedNumber(object, "distance_m");
  if (thing.distance_m < 0) throw std::string("'distance_m' must not be negative");
  if (object.contains("lateral_m")) thing.lateral_m = NeedNumber(object, "lateral_m");
  return thing;
}

ScenarioSession ParseSession(const std::string& line, const Affordances& affordances) {
  const json root = json::parse(line);
  ScenarioSession session;
  session.user = NeedText(root, "user");
  const json& scene = Need(root, "scene");
  if (!scene.is_array() || scene.empty() || scene.size() > kMaxThings) {
    throw "'scene' must be a list of 1 to " + std::to_string(kMaxThings) + " objects";
  }
  bool all_lateral = true;
  for (const json& object : scene) {
    session.scene.push_back(ParseThing(object, affordances));
    all_lateral &= object.contains("lateral_m");
  }
  for (Thing& thing : session.scene) thing.lateral_m = all_lateral ? thing.lateral_m : 0;
  if (root.contains("utime")) session.utime = NeedUtime(root);
  const json& want = Need(root, "want");
  session.want_category = NeedCategory(want, affordances);
  const json& instance = Need(want, "instance");
  if (!instance.is_number_integer()) throw std::string("'instance' must be a whole number");
  session.want_rank = static_cast<int>(std::clamp<int64_t>(instance.get<int64_t>(), 0, 1000));
  const std::string action = NeedText(want, "action");
  session.want_action = affordances.FindAction(action);
  if (session.want_action < 0)
    throw "unknown action '" + action + "', expected one of the affordances file";
  const Situation situation = MakeSituation(affordances, session.scene);
  if (situation.Find(session.want_category, session.want_rank, session.want_action) < 0) {
    throw std::string("what is wanted is not possible in the scene");
  }
  return session;
}

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
  std::ifstream file(path);
  if (!file) return Error{path + ": cannot read the scenario; check --scenario"};
  std::vector<ScenarioLine> lines;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::string place = path + ":" + std::to_string(number) + ": ";
    try {
      lines.push_back({ParseSession(line, affordances), line});
    } catch (const std::string& what) {
      return Error{place + what};
    } catch (const json::exception& e) {
      return Error{place + "not JSON: " + e.what()};
    }
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
  Evaluation evaluation(affordances, **policy, options.config, NowMicroseconds);
  std::map<std::string, int> sessions;
  Totals totals;
  for (const ScenarioLine& line : *lines) {
    const SessionOutcome outcome = evaluation.Live(line.session);
    totals.Add(outcome);
    out << OutputLine(line, outcome, ++sessions[line.session.user], affordances).dump() << '\n';
  }
  out.flush();
  if (!out) return Error{options.jsonl + ": could not be written to the end; is the disk full?"};
  totals.Print();
  return {};
}

}  // namespace beckon::intention
