// Probabilities out of several views, in log space.
#include "services/perception/category_evidence.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "services/perception/categoriser_confidence.h"
#include "services/perception/model.h"

namespace beckon::perception {
namespace {

constexpr double kLeast = 1e-6;      // probability; no view rules a category out
constexpr double kUnheardOf = 0.02;  // of a category that the categoriser does not know
constexpr double kTold = 0.97;       // the user may err too
constexpr double kJumped = 0.5;      // what views from before a jump count
constexpr double kFar_m = 0.1;       // an object carried so far has turned, more likely than not
constexpr double kWhole = 0.7;       // of the largest view's size; less is a part
constexpr double kGrown = 0.5;       // logarithm of the points: as much has come in sight

/// 1 for one and the same view, falling to config.dependence.
double Dependence(const SeenAt& a, const SeenAt& b, const EvidenceConfig& config) {
  const double n_a = static_cast<double>(std::max<size_t>(1, a.n_points));
  const double n_b = static_cast<double>(std::max<size_t>(1, b.n_points));
  const double apart =
      (a.centroid_C - b.centroid_C).norm() / kFar_m + std::abs(std::log(n_a / n_b)) / kGrown;
  return config.dependence + (1 - config.dependence) * std::exp(-apart);
}

/// How large it is seen, whatever its distance.
double Size(const SeenAt& at) {
  return static_cast<double>(at.n_points) * at.centroid_C.squaredNorm();
}

using Logs = std::map<std::string, double>;

/// Sets the probabilities, and what follows of them.
void Write(const Logs& logs, const EvidenceConfig& config, Categorisation& out) {
  double most = -1e300, sum = 0;
  for (const auto& [name, log_p] : logs) most = std::max(most, log_p);
  for (const auto& [name, log_p] : logs) sum += std::exp(log_p - most);
  out.probabilities.clear();
  std::vector<float> all;
  for (const auto& [name, log_p] : logs) {
    all.push_back(static_cast<float>(std::exp(log_p - most) / sum));
    out.probabilities.emplace_back(name, all.back());
  }
  std::ranges::stable_sort(out.probabilities, std::greater<>(),
                           &std::pair<std::string, float>::second);
  out.confidence = RenyiConfidence(all);
  out.ask_user = out.confidence <= config.ask_at_or_below;
}

Logs LogsOf(const Categorisation& category) {
  Logs logs;
  for (const auto& [name, p] : category.probabilities)
    logs[name] = std::log(std::max<double>(p, kLeast));
  return logs;
}

/// The user's word: nearly certain, and what else it might be as it was.
void Obey(const Told& told, const EvidenceConfig& config, Categorisation& category) {
  Logs logs;
  double others = 0;
  for (const auto& [name, p] : category.probabilities) {
    if (name != told.category) others += std::max<double>(p, kLeast);
  }
  for (const auto& [name, p] : category.probabilities)
    logs[name] = std::log((1 - kTold) * std::max<double>(p, kLeast) / others);
  if (logs.empty() && told.category != kUnknown) logs[kUnknown] = std::log(1 - kTold);
  logs[told.category] = std::log(kTold);
  Write(logs, config, category);
  category.ask_user = false;
}

void Weigh(const std::map<std::string, double>& evidence, const EvidenceConfig& config,
           Categorisation& category) {
  if (evidence.empty()) return;
  Logs logs = LogsOf(category);
  if (logs.empty()) logs[kUnknown] = std::log(1 - kUnheardOf);
  for (const auto& [name, log_ratio] : evidence)
    logs.try_emplace(name, std::log(kUnheardOf)).first->second += log_ratio;
  Write(logs, config, category);
}

}  // namespace

Categorisation Combine(const std::vector<Categorisation>& views, const std::vector<SeenAt>& at,
                       const std::vector<double>& weights, const EvidenceConfig& config) {
  double largest = 0;
  for (const SeenAt& seen : at) largest = std::max(largest, Size(seen));
  std::vector<double> w;
  for (size_t i = 0; i < views.size(); ++i)
    w.push_back(weights[i] * std::clamp(Size(at[i]) / std::max(largest, 1e-12), 0.1, 1.0));
  // The variance of a weighted mean of views that depend on each other says how many they count
  // for.
  double sum = 0, dependent = 0;
  for (size_t i = 0; i < views.size(); ++i) {
    sum += w[i];
    for (size_t j = 0; j < views.size(); ++j)
      dependent += w[i] * w[j] * (i == j ? 1 : Dependence(at[i], at[j], config));
  }
  const double power = sum / dependent;  // (sum^2 / dependent) views, of which i has w_i / sum
  Logs logs;
  for (size_t i = 0; i < views.size(); ++i) {
    for (const auto& [name, log_p] : LogsOf(views[i])) logs[name] += power * w[i] * log_p;
  }
  Categorisation combined = views.back();
  Write(logs, config, combined);
  return combined;
}

bool CategoryEvidence::Jumped(const SeenAt& at, const EvidenceConfig& config) const {
  return last_ && (at.centroid_C - last_->centroid_C).norm() > config.jump_m;
}

bool CategoryEvidence::IsNew(const SeenAt& at, const EvidenceConfig& config) const {
  return Jumped(at, config) || std::ranges::none_of(views_, [&](const View& view) {
           const double before = static_cast<double>(view.at.n_points);
           return (at.centroid_C - view.at.centroid_C).norm() <= config.step_m &&
                  std::abs(static_cast<double>(at.n_points) - before) <= config.growth * before;
         });
}

void CategoryEvidence::Add(const SeenAt& at, const InstanceLook& look, Categorisation view,
                           const ToldExamples& examples, const EvidenceConfig& config) {
  if (Jumped(at, config)) {
    for (View& earlier : views_) earlier.weight *= kJumped;
    if (told_ && !examples.IsLike(told_->label_id, look)) told_.reset();
  }
  // What was said of too few points is no view.
  const bool says = !view.probabilities.empty();
  if (says) std::erase_if(views_, [](const View& v) { return v.category.probabilities.empty(); });
  views_.push_back({at, look, std::move(view), 1});
  if (static_cast<int>(views_.size()) > config.most_views) views_.erase(views_.begin());
  last_ = at;
  decided_with_ = -1;
}

bool CategoryEvidence::IsWhole(const SeenAt& at) const {
  return std::ranges::all_of(views_,
                             [&](const View& view) { return Size(at) >= kWhole * Size(view.at); });
}

void CategoryEvidence::Tell(Told told) {
  told_ = std::move(told);
  decided_with_ = -1;
}

void CategoryEvidence::Retract(const std::string& label_id) {
  if (!told_ || told_->label_id != label_id) return;
  told_.reset();
  decided_with_ = -1;
}

const Categorisation& CategoryEvidence::Decide(const ToldExamples& examples,
                                               const EvidenceConfig& config) {
  if (decided_with_ == examples.version()) return decided_;
  decided_with_ = examples.version();
  std::vector<Categorisation> views;
  std::vector<SeenAt> at;
  std::vector<double> weights;
  std::vector<InstanceLook> looks;
  for (const View& view : views_) {
    looks.push_back(view.look);
    if (view.category.probabilities.empty()) continue;
    views.push_back(view.category);
    at.push_back(view.at);
    weights.push_back(view.weight);
  }
  decided_ = views.empty()       ? Categorisation()
             : views.size() == 1 ? views.front()
                                 : Combine(views, at, weights, config);
  told_ ? Obey(*told_, config, decided_) : Weigh(examples.Evidence(looks), config, decided_);
  return decided_;
}

}  // namespace beckon::perception
