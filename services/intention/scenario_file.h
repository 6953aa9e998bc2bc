// Scenario files: one session a line, as JSON (docs/formats.md).
#pragma once

#include <functional>
#include <string>

#include "services/intention/core/evaluation.h"

namespace beckon::intention {

/// A line of a scenario: {"user", "scene": [{"category", "distance_m", "lateral_m"?}, ..], "want":
/// {"category", "instance", "action"}, "utime"?}; other keys are carried through.
struct ScenarioLine {
  ScenarioSession session;
  std::string json;  // the line itself
};

/// Fails with file and line where the line is not of that form, names an unknown category or
/// action, or wants what the scene does not have.
Result<std::vector<ScenarioLine>> ReadScenario(const std::string& path,
                                               const Affordances& affordances);

struct EvaluateOptions {
  std::string scenario;
  std::string policy = "adaptive";
  std::string queries = "all";  // or "aof": action, object and full queries only
  double lambda = 1;            // learning rate of oain
  std::string jsonl;            // output file
  std::string explain;          // where each session is told; "-": standard output; empty: nowhere
  EvaluationConfig config;
};

/// The whole of `beckon-intention evaluate`: writes a line a session, {"user", "session",
/// "questions", "seconds", "answered", "correct", "posterior", "compute_us"} and the carried keys,
/// and prints a summary.
Status Evaluate(const EvaluateOptions& options, const Affordances& affordances);

}  // namespace beckon::intention
