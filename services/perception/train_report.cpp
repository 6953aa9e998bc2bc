// Tables for people, in plain text.
#include "services/perception/train_report.h"

#include <algorithm>
#include <cstdio>

#include "services/perception/cue_interface.h"
#include "services/perception/train_figures.h"

namespace beckon::perception {
namespace {

template <typename... T>
std::string Format(const char* format, T... values) {
  char line[200];
  std::snprintf(line, sizeof(line), format, values...);
  return line;
}

int Best(const std::vector<float>& probabilities) {
  return static_cast<int>(std::max_element(probabilities.begin(), probabilities.end()) -
                          probabilities.begin());
}

bool SurerThan(const Judgement& a, const Judgement& b) { return a.confidence > b.confidence; }

bool Right(const Judgement& j) { return j.label == j.predicted; }

}  // namespace

std::vector<Judgement> Judge(const std::vector<HeldOutPrediction>& predictions) {
  std::vector<Judgement> out;
  for (const HeldOutPrediction& p : predictions) {
    if (p.probabilities.empty()) continue;
    Judgement j;
    j.label = p.label;
    j.predicted = Best(p.probabilities);
    j.confidence = p.confidence;
    j.probability = p.probabilities[static_cast<size_t>(j.predicted)];
    const float own = p.probabilities[static_cast<size_t>(p.label)];
    j.in_top_3 = std::count_if(p.probabilities.begin(), p.probabilities.end(),
                               [own](float other) { return other > own; }) < 3;
    out.push_back(j);
  }
  return out;
}

double Accuracy(const std::vector<Judgement>& judgements) {
  if (judgements.empty()) return 0;
  return static_cast<double>(std::count_if(judgements.begin(), judgements.end(), Right)) /
         static_cast<double>(judgements.size());
}

double Top3Accuracy(const std::vector<Judgement>& judgements) {
  if (judgements.empty()) return 0;
  const auto right = std::count_if(judgements.begin(), judgements.end(),
                                   [](const Judgement& j) { return j.in_top_3; });
  return static_cast<double>(right) / static_cast<double>(judgements.size());
}

double MacroRecall(const std::vector<Judgement>& judgements, size_t categories) {
  double sum = 0;
  int there = 0;
  const auto counts = Confusions(judgements, categories);
  for (size_t c = 0; c < categories; ++c) {
    int views = 0;
    for (const int count : counts[c]) views += count;
    if (views == 0) continue;
    sum += static_cast<double>(counts[c][c]) / views;
    ++there;
  }
  return there > 0 ? sum / there : 0;
}

double SurestAccuracy(const std::vector<Judgement>& judgements, double share) {
  std::vector<Judgement> sorted = judgements;
  std::stable_sort(sorted.begin(), sorted.end(), SurerThan);
  sorted.resize(static_cast<size_t>(share * static_cast<double>(sorted.size()) + 0.5));
  return Accuracy(sorted);
}

float ChooseThreshold(std::vector<Judgement> judgements, double target_accuracy) {
  std::stable_sort(judgements.begin(), judgements.end(), SurerThan);
  int right = 0;
  float threshold = 1;
  for (size_t i = 0; i < judgements.size(); ++i) {
    right += Right(judgements[i]);
    const double accuracy = static_cast<double>(right) / static_cast<double>(i + 1);
    const float next = i + 1 < judgements.size() ? judgements[i + 1].confidence : 0;
    if (accuracy >= target_accuracy && next < judgements[i].confidence) threshold = next;
  }
  return threshold;
}

std::vector<std::vector<int>> Confusions(const std::vector<Judgement>& judgements,
                                         size_t categories) {
  std::vector<std::vector<int>> counts(categories, std::vector<int>(categories, 0));
  for (const Judgement& j : judgements) {
    ++counts[static_cast<size_t>(j.label)][static_cast<size_t>(j.predicted)];
  }
  return counts;
}

std::string ConfusionTable(const std::vector<Judgement>& judgements,
                           const std::vector<std::string>& categories) {
  const auto counts = Confusions(judgements, categories.size());
  std::string out = Format("%-10s", "is \\ taken");
  for (const std::string& category : categories) out += Format(" %5.5s", category.c_str());
  out += "  recall\n";
  for (size_t row = 0; row < categories.size(); ++row) {
    out += Format("%-10.10s", categories[row].c_str());
    int views = 0;
    for (const int count : counts[row]) {
      out += Format(" %5d", count);
      views += count;
    }
    out += views > 0 ? Format("  %6.3f\n", static_cast<double>(counts[row][row]) / views)
                     : "       -\n";
  }
  return out;
}

std::string RiskCoverageTable(const std::vector<Judgement>& judgements, float chosen) {
  std::string out = "    T  answered  right  asked about\n";
  std::vector<std::pair<float, bool>> rows;
  for (int i = 0; i <= 19; ++i) rows.emplace_back(0.05F * static_cast<float>(i), false);
  rows.emplace_back(chosen, true);
  std::sort(rows.begin(), rows.end());
  for (const auto& [threshold, mark] : rows) {
    std::vector<Judgement> answered;
    for (const Judgement& j : judgements) {
      if (j.confidence > threshold) answered.push_back(j);
    }
    const double share = judgements.empty() ? 0
                                            : static_cast<double>(answered.size()) /
                                                  static_cast<double>(judgements.size());
    out += Format("%5.3f  %7.1f%%  %5.3f  %10.1f%%%s\n", static_cast<double>(threshold),
                  100 * share, Accuracy(answered), 100 * (1 - share), mark ? "  <- chosen" : "");
  }
  return out;
}

std::string DeciderName(const Model& model, const Decider& decider) {
  std::string names;
  size_t of_dissertation = 0;
  const auto& three = DissertationCues();
  for (const uint32_t c : decider.cues) {
    names += (names.empty() ? "" : ",") + model.cues[c].name;
    of_dissertation +=
        static_cast<size_t>(std::count(three.begin(), three.end(), model.cues[c].name));
  }
  if (decider.weights.empty() && decider.cues.size() == 3 && of_dissertation == 3)
    return "dissertation";
  return decider.cues.size() > 1 && decider.cues.size() == model.cues.size() ? "all" : names;
}

std::string CueTable(const TrainOutcome& outcome) {
  std::string out =
      "cues          accuracy  macro recall  top 3  surest 70 %    ECE      T   asks\n";
  for (size_t d = 0; d < outcome.model.deciders.size(); ++d) {
    const Decider& decider = outcome.model.deciders[d];
    const Figures f =
        FiguresOf(Judge(outcome.held_out[d]), outcome.model.categories, decider.threshold);
    out += Format("%-13s %8.3f  %12.3f  %5.3f  %11.3f  %5.3f  %5.3f  %4.1f%%\n",
                  DeciderName(outcome.model, decider).c_str(), f.accuracy, f.macro_recall, f.top_3,
                  f.surest_70, f.calibration_error, static_cast<double>(decider.threshold),
                  100 * f.asked);
  }
  return out;
}

}  // namespace beckon::perception
