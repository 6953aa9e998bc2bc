// Checks of a model, and its last stage.
#include "services/perception/model.h"

#include <algorithm>
#include <cmath>

namespace beckon::perception {
namespace {

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

}  // namespace

Status Validate(const Model& model) {
  const size_t classes = model.categories.size();
  if (classes < 2) return Error{"it has fewer than two categories"};
  if (!std::is_sorted(model.categories.begin(), model.categories.end()) ||
      std::adjacent_find(model.categories.begin(), model.categories.end()) !=
          model.categories.end()) {
    return Error{"its categories are not in alphabetical order"};
  }
  if (model.cues.empty()) return Error{"it has no cue"};
  for (const CueModel& cue : model.cues) {
    if (Status status = ValidateCue(cue, classes); !status) return status;
  }
  if (!(model.temperature >= 0.05F && model.temperature <= 20) ||
      !(model.threshold >= 0 && model.threshold <= 1)) {
    return Error{"its temperature or threshold is out of range"};
  }
  return ValidateSvm(model.decider, "the decision", classes,
                     static_cast<int>(model.cues.size() * classes));
}

std::vector<float> Decide(const Model& model, const std::vector<std::vector<float>>& by_cue) {
  return ApplyTemperature(Blend(model.decider.Probabilities(StackFeatures(by_cue)), by_cue),
                          model.temperature);
}

std::vector<float> Blend(const std::vector<float>& decided,
                         const std::vector<std::vector<float>>& by_cue) {
  constexpr double kDoubt = 0.01;             // no cue rules a category out on its own
  constexpr double kDeciderWeight = 1.0 / 3;  // chosen on views of meshes, flat from 0.2 to 0.45
  std::vector<double> product(decided.size());
  double sum = 0;
  for (size_t c = 0; c < decided.size(); ++c) {
    double cues = 0;
    for (const auto& p : by_cue) cues += std::log(static_cast<double>(p[c]) + kDoubt);
    const double own = std::log(static_cast<double>(decided[c]) + 0.1 * kDoubt);
    product[c] = std::exp(kDeciderWeight * own +
                          (1 - kDeciderWeight) * cues / static_cast<double>(by_cue.size()));
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

}  // namespace beckon::perception
