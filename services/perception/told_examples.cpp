// Matching looks with those of named objects.
#include "services/perception/told_examples.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace beckon::perception {
namespace {

// Fitted to the rates of equal and of other products below each difference (docs/model.md).
const double kAtLimit = std::log(10.0);
const double kPerUnit = 1.5;
const double kMost = std::log(300.0);  // two things may look the same

constexpr double kFew = 8;  // objects; of more, one looks alike by chance

}  // namespace

double LogLikelihoodRatio(double difference) {
  if (!(difference < kRecognisedBelow)) return 0;
  return std::min(kMost, kAtLimit + kPerUnit * (kRecognisedBelow - difference));
}

void ToldExamples::Add(ToldExample example) {
  examples_.push_back(std::move(example));
  ++version_;
}

void ToldExamples::Remove(const std::string& label_id) {
  version_ += std::erase_if(examples_, [&](const auto& e) { return e.label_id == label_id; }) > 0;
}

int ToldExamples::Count(const std::string& label_id) const {
  return static_cast<int>(std::ranges::count(examples_, label_id, &ToldExample::label_id));
}

std::map<std::string, double> ToldExamples::Evidence(const std::vector<InstanceLook>& looks) const {
  std::set<std::string> objects;
  for (const ToldExample& example : examples_) objects.insert(example.label_id);
  const double by_chance = std::log(std::max(1.0, static_cast<double>(objects.size()) / kFew));
  std::map<std::string, double> evidence;
  for (const ToldExample& example : examples_) {
    for (const InstanceLook& look : looks) {
      const double log_ratio = LogLikelihoodRatio(Difference(look, example.look)) - by_chance;
      if (log_ratio <= 0) continue;
      double& best = evidence[example.category];
      best = std::max(best, log_ratio);
    }
  }
  return evidence;
}

bool ToldExamples::IsLike(const std::string& label_id, const InstanceLook& look) const {
  return std::ranges::any_of(examples_, [&](const ToldExample& example) {
    return example.label_id == label_id && Difference(look, example.look) < kRecognisedBelow;
  });
}

}  // namespace beckon::perception
