// Judging a model on a folder of views.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "services/perception/categoriser.h"
#include "services/perception/model.h"
#include "services/perception/train_data.h"
#include "services/perception/train_figures.h"
#include "services/perception/train_program.h"

namespace beckon::perception {
namespace {

std::string Line(const ViewRecord& record, const Categorisation& result) {
  nlohmann::ordered_json line;
  line["file"] = record.file;
  line["category"] = record.category;
  line["predicted"] = result.probabilities.empty() ? kUnknown : result.probabilities[0].first;
  line["probabilities"] = nlohmann::ordered_json::object();
  for (const auto& [category, p] : result.probabilities) line["probabilities"][category] = p;
  line["confidence"] = result.confidence;
  line["ask_user"] = result.ask_user;
  line["time_ms"] = result.milliseconds;
  return line.dump();
}

/// Where in `names` a name is; a name that is not there counts as Unknown, which is.
int IndexOf(const std::vector<std::string>& names, const std::string& name) {
  auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) at = std::find(names.begin(), names.end(), kUnknown);
  return static_cast<int>(at - names.begin());
}

Judgement JudgeOne(const Categorisation& result, const std::vector<std::string>& names,
                   const std::string& label) {
  Judgement j;
  j.label = IndexOf(names, label);
  j.predicted = IndexOf(names, kUnknown);
  j.confidence = result.confidence;
  if (!result.probabilities.empty()) {
    j.predicted = IndexOf(names, result.probabilities[0].first);
    j.probability = result.probabilities[0].second;
  }
  const size_t shown = std::min<size_t>(3, result.probabilities.size());
  for (size_t i = 0; i < shown; ++i) {
    if (result.probabilities[i].first == label) j.in_top_3 = true;
  }
  return j;
}

/// The model's categories, and "Unknown" where they lack it: what IndexOf gives for other names.
std::vector<std::string> NamesWithUnknown(const Categoriser& categoriser) {
  std::vector<std::string> names = categoriser.categories();
  if (std::find(names.begin(), names.end(), kUnknown) == names.end()) names.push_back(kUnknown);
  return names;
}

struct Tally {
  std::vector<Judgement> judgements;
  std::vector<double> times_ms;
  std::map<std::string, double> cue_ms;  // sums
  int skipped = 0, unanswered = 0;
};

void Print(Tally& tally, const Categoriser& categoriser, const std::vector<std::string>& names) {
  std::sort(tally.times_ms.begin(), tally.times_ms.end());
  const auto views = static_cast<double>(tally.judgements.size());
  std::printf(
      "%zu views, %d skipped, %d without an answer\n%s\n", tally.judgements.size(), tally.skipped,
      tally.unanswered,
      Text(FiguresOf(tally.judgements, categoriser.categories(), categoriser.threshold())).c_str());
  std::printf("time per object: median %.1f ms, longest %.1f ms (",
              tally.times_ms[tally.times_ms.size() / 2], tally.times_ms.back());
  const char* comma = "";
  for (const auto& [cue, ms] : tally.cue_ms) {
    std::printf("%s%s %.1f", comma, cue.c_str(), ms / views);
    comma = ", ";
  }
  std::printf(" on average)\n\n%s\n%s", ConfusionTable(tally.judgements, names).c_str(),
              RiskCoverageTable(OfKnown(tally.judgements, categoriser.categories()),
                                categoriser.threshold())
                  .c_str());
}

Result<Categoriser> LoadForTest(const TrainOptions& options) {
  Result<Categoriser> categoriser = Categoriser::Load(options.model);
  if (!categoriser || options.cues.empty()) return categoriser;
  if (Status status = categoriser->UseCues(options.cues); !status) {
    return Error{options.model + ": " + status.error().message};
  }
  return categoriser;
}

}  // namespace

Status RunTest(const TrainOptions& options) {
  const auto categoriser = LoadForTest(options);
  if (!categoriser) return categoriser.error();
  const auto records = ListViews(options.test);
  if (!records) return records.error();
  std::ofstream lines;
  if (!options.jsonl.empty()) {
    lines.open(options.jsonl, std::ios::trunc);
    if (!lines)
      return Error{options.jsonl + ": cannot be written; expected a file in a folder that exists"};
  }
  const std::vector<std::string> names = NamesWithUnknown(*categoriser);
  Tally tally;
  for (const ViewRecord& record : *records) {
    if (options.stopped && options.stopped()) return Error{"stopped on request"};
    const Result<LoadedView> view = LoadView(record);
    if (!view) {
      std::fprintf(stderr, "skipped %s: %s\n", record.file.c_str(), view.error().message.c_str());
      ++tally.skipped;
      continue;
    }
    const Categorisation result = categoriser->Categorise(view->view());
    if (!result.reason.empty()) {
      std::fprintf(stderr, "%s: %s\n", record.file.c_str(), result.reason.c_str());
      ++tally.unanswered;
    }
    if (lines.is_open()) lines << Line(record, result) << '\n';
    tally.judgements.push_back(JudgeOne(result, names, record.category));
    tally.times_ms.push_back(result.milliseconds);
    for (const auto& cue : result.cues) tally.cue_ms[cue.name] += cue.milliseconds;
  }
  if (lines.is_open() && !lines.flush())
    return Error{options.jsonl + ": could not be written whole"};
  if (tally.judgements.empty()) return Error{options.test + ": no view of it could be read"};
  Print(tally, *categoriser, names);
  return DrawPictures(options, tally.judgements, names, categoriser->threshold());
}

}  // namespace beckon::perception
