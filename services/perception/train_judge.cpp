// Judging a model on a folder of views.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "services/perception/categoriser.h"
#include "services/perception/train_data.h"
#include "services/perception/train_program.h"
#include "services/perception/train_report.h"

namespace beckon::perception {
namespace {

std::string Line(const ViewRecord& record, const Categorisation& result) {
  nlohmann::ordered_json line;
  line["file"] = record.file;
  line["category"] = record.category;
  line["predicted"] = result.probabilities.empty() ? "Unknown" : result.probabilities[0].first;
  line["probabilities"] = nlohmann::ordered_json::object();
  for (const auto& [category, p] : result.probabilities) line["probabilities"][category] = p;
  line["confidence"] = result.confidence;
  line["ask_user"] = result.ask_user;
  line["time_ms"] = result.milliseconds;
  return line.dump();
}

/// Where in `categories` a name is; a name the model does not know comes after all.
int IndexOf(const std::vector<std::string>& categories, const std::string& name) {
  return static_cast<int>(std::find(categories.begin(), categories.end(), name) -
                          categories.begin());
}

Judgement JudgeOne(const Categorisation& result, const std::vector<std::string>& categories,
                   const std::string& label) {
  Judgement j;
  j.label = IndexOf(categories, label);
  j.predicted = static_cast<int>(categories.size());
  j.confidence = result.confidence;
  if (!result.probabilities.empty())
    j.predicted = IndexOf(categories, result.probabilities[0].first);
  const size_t shown = std::min<size_t>(3, result.probabilities.size());
  for (size_t i = 0; i < shown; ++i) {
    if (result.probabilities[i].first == label) j.in_top_3 = true;
  }
  return j;
}

struct Tally {
  std::vector<Judgement> judgements;
  std::vector<double> times_ms;
  std::vector<double> cue_ms;  // sums, by cue
  int skipped = 0, asked = 0;
};

void Print(Tally& tally, const Categoriser& categoriser, const std::vector<std::string>& cues) {
  std::vector<std::string> names = categoriser.categories();
  names.push_back("Unknown");
  std::sort(tally.times_ms.begin(), tally.times_ms.end());
  const auto views = static_cast<double>(tally.judgements.size());
  std::printf("%zu views, %d skipped\n", tally.judgements.size(), tally.skipped);
  std::printf(
      "accuracy %.3f, macro recall %.3f, top 3 %.3f, surest 70 %% %.3f, asks about %.1f %%\n",
      Accuracy(tally.judgements), MacroRecall(tally.judgements, names.size()),
      Top3Accuracy(tally.judgements), SurestAccuracy(tally.judgements, 0.7),
      100 * tally.asked / views);
  std::printf("time per object: median %.1f ms, longest %.1f ms (",
              tally.times_ms[tally.times_ms.size() / 2], tally.times_ms.back());
  for (size_t i = 0; i < cues.size(); ++i) {
    std::printf("%s%s %.1f", i > 0 ? ", " : "", cues[i].c_str(), tally.cue_ms[i] / views);
  }
  std::printf(" on average)\n\n%s\n%s", ConfusionTable(tally.judgements, names).c_str(),
              RiskCoverageTable(tally.judgements, categoriser.threshold()).c_str());
}

}  // namespace

Status RunTest(const TrainOptions& options) {
  const auto categoriser = Categoriser::Load(options.model);
  if (!categoriser) return categoriser.error();
  const auto records = ListViews(options.test);
  if (!records) return records.error();
  std::ofstream lines;
  if (!options.jsonl.empty()) {
    lines.open(options.jsonl, std::ios::trunc);
    if (!lines)
      return Error{options.jsonl + ": cannot be written; expected a file in a folder that exists"};
  }
  Tally tally;
  std::vector<std::string> cues;
  for (const ViewRecord& record : *records) {
    const Result<LoadedView> view = LoadView(record);
    if (!view) {
      std::fprintf(stderr, "skipped %s: %s\n", record.file.c_str(), view.error().message.c_str());
      ++tally.skipped;
      continue;
    }
    const Categorisation result = categoriser->Categorise(view->view());
    if (lines.is_open()) lines << Line(record, result) << '\n';
    tally.judgements.push_back(JudgeOne(result, categoriser->categories(), record.category));
    tally.times_ms.push_back(result.milliseconds);
    tally.asked += result.ask_user;
    tally.cue_ms.resize(std::max(tally.cue_ms.size(), result.cues.size()));
    if (cues.empty())
      for (const auto& cue : result.cues) cues.push_back(cue.name);
    for (size_t i = 0; i < result.cues.size(); ++i) tally.cue_ms[i] += result.cues[i].milliseconds;
  }
  if (lines.is_open() && !lines.flush())
    return Error{options.jsonl + ": could not be written whole"};
  if (tally.judgements.empty()) return Error{options.test + ": no view of it could be read"};
  Print(tally, *categoriser, cues);
  if (options.picture.empty()) return {};
  std::vector<std::string> names = categoriser->categories();
  names.push_back("Unknown");
  return DrawConfusions(tally.judgements, names, options.picture);
}

}  // namespace beckon::perception
