// Known and unknown apart, claims against truth.
#include "services/perception/train_figures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace beckon::perception {
namespace {

bool IsNone(int index, const std::vector<std::string>& categories) {
  return index < 0 || static_cast<size_t>(index) >= categories.size() ||
         categories[static_cast<size_t>(index)] == kUnknown;
}

}  // namespace

std::vector<Judgement> OfKnown(const std::vector<Judgement>& judgements,
                               const std::vector<std::string>& categories) {
  std::vector<Judgement> known;
  for (const Judgement& j : judgements) {
    if (!IsNone(j.label, categories)) known.push_back(j);
  }
  return known;
}

Figures FiguresOf(const std::vector<Judgement>& judgements,
                  const std::vector<std::string>& categories, float threshold) {
  const std::vector<Judgement> known = OfKnown(judgements, categories);
  Figures out;
  out.views = known.size();
  out.accuracy = Accuracy(known);
  out.macro_recall = MacroRecall(known, categories.size() + 1);
  out.top_3 = Top3Accuracy(known);
  out.surest_70 = SurestAccuracy(known, 0.7);
  out.calibration_error = CalibrationError(known);
  for (const Judgement& j : known) out.asked += j.confidence <= threshold;
  out.asked /= std::max(1.0, static_cast<double>(known.size()));
  for (const Judgement& j : judgements) {
    if (!IsNone(j.label, categories)) continue;
    ++out.unknown_views;
    out.unknown_named += !IsNone(j.predicted, categories) && j.confidence > threshold;
  }
  out.unknown_named /= std::max(1.0, static_cast<double>(out.unknown_views));
  return out;
}

std::string Text(const Figures& f) {
  char text[400];
  std::snprintf(text, sizeof(text),
                "accuracy %.3f, macro recall %.3f, top 3 %.3f, surest 70 %% %.3f, asks about %.1f "
                "%%, calibration error %.3f (%zu views of known categories)",
                f.accuracy, f.macro_recall, f.top_3, f.surest_70, 100 * f.asked,
                f.calibration_error, f.views);
  std::string out = text;
  if (f.unknown_views == 0) return out;
  std::snprintf(text, sizeof(text),
                "\nof %zu views of none of the categories %.1f %% are named as one unasked",
                f.unknown_views, 100 * f.unknown_named);
  return out + text;
}

std::vector<ReliabilityBin> Reliability(std::vector<Judgement> judgements, size_t bins) {
  std::stable_sort(
      judgements.begin(), judgements.end(),
      [](const Judgement& a, const Judgement& b) { return a.probability < b.probability; });
  std::vector<ReliabilityBin> out;
  const size_t n = judgements.size();
  for (size_t b = 0; b < bins; ++b) {
    ReliabilityBin bin;
    for (size_t i = b * n / bins; i < (b + 1) * n / bins; ++i) {
      ++bin.views;
      bin.probability += static_cast<double>(judgements[i].probability);
      bin.accuracy += judgements[i].label == judgements[i].predicted;
    }
    if (bin.views == 0) continue;
    bin.probability /= static_cast<double>(bin.views);
    bin.accuracy /= static_cast<double>(bin.views);
    out.push_back(bin);
  }
  return out;
}

double CalibrationError(const std::vector<Judgement>& judgements) {
  double sum = 0;
  for (const ReliabilityBin& bin : Reliability(judgements)) {
    sum += static_cast<double>(bin.views) * std::abs(bin.probability - bin.accuracy);
  }
  return sum / std::max(1.0, static_cast<double>(judgements.size()));
}

}  // namespace beckon::perception
