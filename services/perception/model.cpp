// Checks of a model, and its last stage.
#include "services/perception/model.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace beckon::perception {
namespace {

constexpr double kDoubt = 0.01;  // no cue rules a category out on its own

Status ValidateSvm(const SvmClassifier& svm, const std::string& name, size_t classes,
                   int dimension) {
  const bool fits = svm.rho.size() == classes && svm.sigmoids.size() == classes &&
                    svm.coefficients.rows() == static_cast<int64_t>(classes) &&
                    svm.coefficients.cols() == svm.vectors.rows() && svm.dimension() == dimension;
  if (!fits) return Error{"the classifier of " + name + " does not fit its features"};
  bool finite = std::isfinite(svm.gamma) && svm.gamma > 0 && svm.coefficients.allFinite();
  for (const float rho : svm.rho) finite = finite && std::isfinite(rho);
  for (const Sigmoid& s : svm.sigmoids) finite = finite && std::isfinite(s.a) && std::isfinite(s.b);
  if (!finite) return Error{"the classifier of " + name + " holds numbers that are not finite"};
  return {};
}

Status ValidateCue(const CueModel& cue_model, size_t classes) {
  const auto cue = MakeCue(cue_model.name);
  if (!cue) return Error{"it has a cue \"" + cue_model.name + "\" that this program does not know"};
  const CueEncoder& encoder = cue_model.encoder;
  const bool bag = cue->encoding() == Encoding::kBag;
  const bool statistics = cue->encoding() == Encoding::kStatistics;
  if ((bag && encoder.vocabulary.cols() != cue->dimension()) ||
      (statistics && (encoder.quantiles.cols() != cue->dimension() ||
                      encoder.quantiles.rows() != CueEncoder::kQuantiles))) {
    return Error{"its cue \"" + cue_model.name + "\" measures other things than this program's"};
  }
  if (!encoder.vocabulary.allFinite() || !encoder.quantiles.allFinite()) {
    return Error{"its cue \"" + cue_model.name + "\" holds numbers that are not finite"};
  }
  return ValidateSvm(cue_model.classifier, "cue \"" + cue_model.name + "\"", classes,
                     encoder.FeatureCount(*cue));
}

Status ValidateDecider(const Decider& decider, const Model& model) {
  const auto& cues = decider.cues;
  if (cues.empty() || cues.back() >= model.cues.size() ||
      std::adjacent_find(cues.begin(), cues.end(), std::greater_equal<>()) != cues.end()) {
    return Error{"a decider's cues are not among the model's, in their order"};
  }
  const auto is_weight = [](float w) { return std::isfinite(w) && w >= 0; };
  const bool has_weight =
      std::any_of(decider.weights.begin(), decider.weights.end(), [](float w) { return w > 0; });
  if (!decider.weights.empty() &&
      (decider.weights.size() != cues.size() || !has_weight ||
       !std::all_of(decider.weights.begin(), decider.weights.end(), is_weight))) {
    return Error{"a decider's weights do not fit its cues"};
  }
  if (!(decider.temperature >= 0.05F && decider.temperature <= 20) ||
      !(decider.threshold >= 0 && decider.threshold <= 1)) {
    return Error{"its temperature or threshold is out of range"};
  }
  if (cues.size() == 1 && decider.svm.classes() == 0 && decider.correction.classes() == 0)
    return {};
  if (decider.correction.classes() > 0) {
    Status status = ValidateSvm(decider.correction, "the correction", model.categories.size(),
                                static_cast<int>(cues.size() * model.categories.size()));
    if (!status) return status;
  }
  return ValidateSvm(decider.svm, "the decision", model.categories.size(),
                     static_cast<int>(cues.size() * model.categories.size()));
}

/// The weighted mean of the cues' log probabilities of one category; without weights all count
/// alike.
double MeanLog(const std::vector<float>& weights, const std::vector<std::vector<float>>& by_cue,
               size_t category) {
  double sum = 0, total = 0;
  for (size_t i = 0; i < by_cue.size(); ++i) {
    const double weight = weights.empty() ? 1 : static_cast<double>(weights[i]);
    sum += weight * std::log(static_cast<double>(by_cue[i][category]) + kDoubt);
    total += weight;
  }
  return sum / std::max(1e-6, total);
}

}  // namespace

Status Validate(const Model& model) {
  const size_t classes = model.categories.size();
  if (classes < 2) return Error{"it has fewer than two categories"};
  if (classes > kMostCategories) {
    return Error{"it has more than " + std::to_string(kMostCategories) + " categories"};
  }
  if (!std::is_sorted(model.categories.begin(), model.categories.end()) ||
      std::adjacent_find(model.categories.begin(), model.categories.end()) !=
          model.categories.end()) {
    return Error{"its categories are not in alphabetical order"};
  }
  if (model.cues.empty()) return Error{"it has no cue"};
  for (const CueModel& cue : model.cues) {
    if (Status status = ValidateCue(cue, classes); !status) return status;
  }
  if (!(model.unknown_prior >= 0.001F && model.unknown_prior <= 1000)) {
    return Error{"its prior of the unknown is out of range"};
  }
  if (model.deciders.empty()) return Error{"it has no decider"};
  for (const Decider& decider : model.deciders) {
    if (Status status = ValidateDecider(decider, model); !status) return status;
  }
  if (model.deciders.front().cues.size() != model.cues.size()) {
    return Error{"its first decider is not over all cues"};
  }
  return {};
}

const Decider* FindDecider(const Model& model, const std::vector<uint32_t>& cues) {
  for (const Decider& decider : model.deciders) {
    if (decider.cues == cues) return &decider;
  }
  return nullptr;
}

std::vector<float> Decide(const Decider& decider, std::vector<std::vector<float>> by_cue) {
  if (!FillMissing(decider.weights, by_cue)) return {};
  if (decider.svm.classes() == 0) {
    return ApplyTemperature(by_cue.front(), decider.temperature);
  }
  const Features features = StackFeatures(by_cue);
  const std::vector<float> decided = decider.svm.Probabilities(features);
  std::vector<float> out =
      ApplyTemperature(decider.weights.empty() ? decided : Blend(decided, decider.weights, by_cue),
                       decider.temperature);
  if (decider.correction.classes() == 0) return out;
  out = CorrectionOffsets(out);
  const Eigen::VectorXf more = decider.correction.Decide(features);
  Eigen::Map<Eigen::VectorXf> odds(out.data(), more.size());
  odds += more;
  odds = (odds.array() - odds.maxCoeff()).exp();
  odds /= odds.sum();
  return out;
}

std::vector<float> CorrectionOffsets(const std::vector<float>& decided) {
  constexpr float kLeast = 1e-3F;
  std::vector<float> offsets;
  for (const float p : decided) offsets.push_back(std::log(std::max(p, kLeast)));
  return offsets;
}

bool FillMissing(const std::vector<float>& weights, std::vector<std::vector<float>>& by_cue) {
  std::vector<std::vector<float>> seen;
  std::vector<float> seen_weights;
  for (size_t i = 0; i < by_cue.size(); ++i) {
    if (by_cue[i].empty()) continue;
    seen.push_back(by_cue[i]);
    if (!weights.empty()) seen_weights.push_back(weights[i]);
  }
  if (seen.empty()) return false;
  if (seen.size() == by_cue.size()) return true;
  const std::vector<float> mean = MeanOfCues(seen_weights, seen);
  for (auto& p : by_cue) {
    if (p.empty()) p = mean;
  }
  return true;
}

std::vector<float> MeanOfCues(const std::vector<float>& weights,
                              const std::vector<std::vector<float>>& by_cue) {
  std::vector<float> out(by_cue.front().size());
  float sum = 0;
  for (size_t c = 0; c < out.size(); ++c) {
    out[c] = static_cast<float>(std::exp(MeanLog(weights, by_cue, c)));
    sum += out[c];
  }
  for (float& p : out) p /= sum;
  return out;
}

std::vector<float> Blend(const std::vector<float>& decided, const std::vector<float>& weights,
                         const std::vector<std::vector<float>>& by_cue) {
  constexpr double kDeciderWeight = 1.0 / 3;  // chosen on views of meshes, flat from 0.2 to 0.45
  std::vector<double> product(decided.size());
  double sum = 0;
  for (size_t c = 0; c < decided.size(); ++c) {
    const double own = std::log(static_cast<double>(decided[c]) + 0.1 * kDoubt);
    product[c] =
        std::exp(kDeciderWeight * own + (1 - kDeciderWeight) * MeanLog(weights, by_cue, c));
    sum += product[c];
  }
  std::vector<float> out;
  for (const double p : product) out.push_back(static_cast<float>(p / sum));
  return out;
}

Features StackFeatures(const std::vector<std::vector<float>>& by_cue) {
  Features features;
  for (const auto& probabilities : by_cue) {
    // The square root spreads out the small ones, and makes the distance Hellinger's.
    const Eigen::Map<const Eigen::RowVectorXf> p(probabilities.data(),
                                                 static_cast<int64_t>(probabilities.size()));
    const Features part = ToFeatures(p.cwiseSqrt());
    features.insert(features.end(), part.begin(), part.end());
  }
  return features;
}

std::vector<float> ApplyTemperature(const std::vector<float>& probabilities, float temperature) {
  std::vector<float> out(probabilities.size());
  float sum = 0;
  for (size_t i = 0; i < out.size(); ++i) {
    out[i] = std::pow(std::max(1e-9F, probabilities[i]), 1 / temperature);
    sum += out[i];
  }
  for (float& p : out) p /= sum;
  return out;
}

void ApplyUnknownPrior(const std::vector<std::string>& categories, float prior,
                       std::vector<float>& probabilities) {
  const auto at = std::find(categories.begin(), categories.end(), kUnknown);
  if (at == categories.end() || probabilities.size() != categories.size()) return;
  probabilities[static_cast<size_t>(at - categories.begin())] *= prior;
  float sum = 0;
  for (const float p : probabilities) sum += p;
  for (float& p : probabilities) p /= sum;
}

}  // namespace beckon::perception
