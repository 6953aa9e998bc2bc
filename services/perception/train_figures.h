// The figures a model is judged by: over views of known categories, and apart from them over views
// of what is none of them.
#pragma once

#include <string>
#include <vector>

#include "services/perception/train_report.h"

namespace beckon::perception {

struct Figures {
  size_t views = 0;  // of known categories; the figures are theirs
  double accuracy = 0;
  double macro_recall = 0;
  double top_3 = 0;
  double surest_70 = 0;          // accuracy of the 70 % with the highest confidence
  double calibration_error = 0;  // CalibrationError
  double asked = 0;              // share at or below the threshold
  size_t unknown_views = 0;      // of what is none of the categories
  double unknown_named = 0;      // share of them that is named as one, and nobody asked
};

/// Labels from `categories.size()` on, and that of kUnknown, are what is none of the categories;
/// so are predictions.
Figures FiguresOf(const std::vector<Judgement>& judgements,
                  const std::vector<std::string>& categories, float threshold);
std::string Text(const Figures& figures);

/// Those of the judgements whose view shows one of the categories.
std::vector<Judgement> OfKnown(const std::vector<Judgement>& judgements,
                               const std::vector<std::string>& categories);

/// Views of like probability of what was said.
struct ReliabilityBin {
  size_t views = 0;
  double probability = 0;  // mean of what was claimed
  double accuracy = 0;     // what came true
};

/// Bins of equal counts, least probable first; fewer than `bins` where there are fewer views.
std::vector<ReliabilityBin> Reliability(std::vector<Judgement> judgements, size_t bins = 10);

/// The expected calibration error: the mean difference of claim and truth over 10 such bins.
double CalibrationError(const std::vector<Judgement>& judgements);

}  // namespace beckon::perception
