#include "services/intention/core/label_match.h"

#include <cmath>
#include <map>

namespace beckon::intention {
namespace {

/// Half the sum of absolute differences, 0 (same) .. 1 (nothing in common).
double TotalVariation(const std::vector<msg::CategoryProbability>& a,
                      const std::vector<msg::CategoryProbability>& b) {
  std::map<std::string, double> difference;
  for (const auto& p : a) difference[p.category] += p.probability;
  for (const auto& p : b) difference[p.category] -= p.probability;
  double sum = 0;
  for (const auto& [category, d] : difference) sum += std::abs(d);
  return sum / 2;
}

}  // namespace

const LabelRecord* FindLabel(const std::vector<LabelRecord>& labels, const std::string& source,
                             const msg::SceneObject& object, const LabelMatchConfig& config) {
  for (auto label = labels.rbegin(); label != labels.rend(); ++label) {
    if (label->source != source) continue;
    if ((label->centroid_W - object.centroid_W).norm() > config.place_m) continue;
    if ((label->extent_W - object.extent_W).cwiseAbs().maxCoeff() > config.extent_m) continue;
    if (TotalVariation(label->probabilities, object.probabilities) > config.likeness) continue;
    return &*label;
  }
  return nullptr;
}

bool LooksAlike(const msg::SceneObject& a, const msg::SceneObject& b,
                const LabelMatchConfig& config) {
  const bool sizes_known = !a.extent_W.isZero() && !b.extent_W.isZero();
  if (sizes_known && (a.extent_W - b.extent_W).cwiseAbs().maxCoeff() > config.extent_m)
    return false;
  const bool opinions_known = !a.probabilities.empty() && !b.probabilities.empty();
  return !opinions_known || TotalVariation(a.probabilities, b.probabilities) <= config.likeness;
}

}  // namespace beckon::intention
