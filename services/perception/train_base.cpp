// Kernel logistic regression around a model.
#include "services/perception/train_base.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "services/perception/categoriser.h"
#include "services/perception/categoriser_confidence.h"
#include "services/perception/cue_interface.h"

namespace beckon::perception {
namespace {

// Chosen with real views in halves by product: a third of each does as well.
constexpr float kGammaScale = 3;  // gamma of the bumps over that of the decider's machine
constexpr float kPenalty = 0.1F;  // on the squares of the bumps' heights
constexpr int kSteps = 300;       // of gradient descent

int IndexOf(const std::vector<std::string>& sorted, const std::string& name) {
  return static_cast<int>(std::lower_bound(sorted.begin(), sorted.end(), name) - sorted.begin());
}

Eigen::MatrixXf Softmax(const Eigen::MatrixXf& odds) {
  Eigen::MatrixXf p = (odds.colwise() - odds.rowwise().maxCoeff()).array().exp();
  return p.array().colwise() / p.rowwise().sum().array();
}

/// Heights of the bumps, view x class: minimises sum_i w_i -log p_i(y_i) + penalty / 2 |heights|^2
/// along the kernel's metric, for log-odds offsets + kernel * heights.
Eigen::MatrixXf FitHeights(const Eigen::MatrixXf& kernel, const Eigen::MatrixXf& offsets,
                           const Eigen::MatrixXf& truth, const Eigen::VectorXf& weights) {
  Eigen::MatrixXf heights = Eigen::MatrixXf::Zero(truth.rows(), truth.cols());
  const float step = 1 / (kPenalty + 0.5F * kernel.rowwise().sum().maxCoeff());
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::MatrixXf error = Softmax(offsets + kernel * heights) - truth;
    heights -= step * (weights.asDiagonal() * error + kPenalty * heights);
  }
  return heights;
}

/// Appends the new bumps to those that are there.
SvmClassifier Append(const SvmClassifier& old, float gamma, const std::vector<Features>& centres,
                     const Eigen::MatrixXf& heights) {
  SvmClassifier out;
  const int64_t before = old.classes() > 0 ? old.vectors.rows() : 0;
  const auto added = static_cast<int64_t>(centres.size());
  out.gamma = gamma;
  out.vectors.resize(before + added, static_cast<int64_t>(centres.front().size()));
  out.coefficients.resize(heights.cols(), before + added);
  if (before > 0) {
    out.vectors.topRows(before) = old.vectors;
    out.coefficients.leftCols(before) = old.coefficients;
  }
  for (int64_t i = 0; i < added; ++i) {
    out.vectors.row(before + i) = Eigen::Map<const Eigen::Matrix<uint8_t, 1, Eigen::Dynamic>>(
        centres[static_cast<size_t>(i)].data(), out.vectors.cols());
  }
  out.coefficients.rightCols(added) = heights.transpose();
  out.rho.assign(static_cast<size_t>(heights.cols()), 0);
  out.sigmoids.resize(out.rho.size());
  out.Prepare();
  return out;
}

}  // namespace

BaseTrainer::BaseTrainer(Model base, const std::vector<std::string>& categories)
    : model_(std::move(base)), wanted_(categories) {
  for (const std::string& category : categories) AddCategory(category, model_);
  for (const CueModel& cue : model_.cues) cues_.push_back(MakeCue(cue.name));
}

Result<std::vector<std::vector<float>>> BaseTrainer::Describe(const ObjectView& view) const {
  if (const int points = CountPoints(view); points < Categoriser::kMinPoints) {
    return Error{"expected at least " + std::to_string(Categoriser::kMinPoints) +
                 " points with depth, found " + std::to_string(points)};
  }
  const CueView prepared = MakeCueView(view);
  std::vector<std::vector<float>> by_cue;
  for (size_t c = 0; c < cues_.size(); ++c) {
    by_cue.emplace_back();
    if (!cues_[c]->CanSee(prepared)) continue;
    by_cue.back() = model_.cues[c].classifier.Probabilities(
        model_.cues[c].encoder.Encode(*cues_[c], cues_[c]->Describe(prepared)));
  }
  return by_cue;
}

void BaseTrainer::Add(std::vector<std::vector<float>> by_cue, const std::string& category,
                      const std::string& instance) {
  by_cue_.push_back(std::move(by_cue));
  labels_.push_back(IndexOf(model_.categories, category));
  instances_.push_back(category + "/" + instance);
}

Status BaseTrainer::CheckCategories() const {
  if (labels_.empty()) return Error{"expected views to improve the model with, found none usable"};
  for (const std::string& category : wanted_) {
    const int label = IndexOf(model_.categories, category);
    if (std::find(labels_.begin(), labels_.end(), label) != labels_.end()) continue;
    return Error{"expected a view of each category, found none usable of " + category +
                 "; add views of it, or remove its folder"};
  }
  return {};
}

std::vector<std::vector<float>> BaseTrainer::InputOf(const Decider& decider, size_t view) const {
  std::vector<std::vector<float>> input;
  for (const uint32_t c : decider.cues) input.push_back(by_cue_[view][c]);
  return input;
}

HeldOutPrediction BaseTrainer::Predict(const Decider& decider, size_t view) const {
  HeldOutPrediction out;
  out.label = labels_[view];
  out.probabilities = Decide(decider, InputOf(decider, view));
  ApplyUnknownPrior(model_.categories, model_.unknown_prior, out.probabilities);
  out.confidence = RenyiConfidence(out.probabilities);
  return out;
}

SvmClassifier BaseTrainer::Correct(const Decider& decider, const std::vector<size_t>& views) const {
  std::map<std::string, int> views_of;
  std::vector<size_t> seen;
  for (const size_t view : views) {
    auto input = InputOf(decider, view);
    if (!FillMissing(decider.weights, input)) continue;
    seen.push_back(view);
    ++views_of[instances_[view]];
  }
  if (seen.empty()) return decider.correction;
  const auto n = static_cast<int64_t>(seen.size());
  const auto k = static_cast<int64_t>(model_.categories.size());
  const float gamma = kGammaScale * decider.svm.gamma;
  std::vector<Features> centres;
  Eigen::MatrixXf offsets(n, k), truth = Eigen::MatrixXf::Zero(n, k);
  Eigen::VectorXf weights(n);
  for (int64_t i = 0; i < n; ++i) {
    const size_t view = seen[static_cast<size_t>(i)];
    auto input = InputOf(decider, view);
    const auto odds = CorrectionOffsets(Decide(decider, input));
    offsets.row(i) = Eigen::Map<const Eigen::RowVectorXf>(odds.data(), k);
    truth(i, labels_[view]) = 1;
    weights[i] = 1 / std::sqrt(static_cast<float>(views_of[instances_[view]]));
    FillMissing(decider.weights, input);
    centres.push_back(StackFeatures(input));
  }
  // Of the distances the same sum that the correction will be evaluated with.
  SvmClassifier unit = Append({}, gamma, centres, Eigen::MatrixXf::Identity(n, n));
  Eigen::MatrixXf kernel(n, n);
  for (int64_t i = 0; i < n; ++i) kernel.col(i) = unit.Decide(centres[static_cast<size_t>(i)]);
  return Append(decider.correction, gamma, centres, FitHeights(kernel, offsets, truth, weights));
}

Result<BaseTrainer::Outcome> BaseTrainer::Finish(const TrainConfig& config, const Watch& watch) {
  if (Status status = CheckCategories(); !status) return status.error();
  // In turn over all objects: there may be but one of a category.
  std::map<std::string, int> fold_of;
  for (const std::string& instance : instances_) fold_of[instance] = 0;
  int next = 0;
  for (auto& entry : fold_of) entry.second = next++ % config.folds;
  Outcome out;
  out.improved.model = model_;
  for (size_t d = 0; d < model_.deciders.size(); ++d) {
    if (watch && !watch("improving the decisions", d, model_.deciders.size())) {
      return Error{"stopped on request; no model was written"};
    }
    const Decider& base = model_.deciders[d];
    std::vector<HeldOutPrediction> held_out(labels_.size());
    const bool corrected = base.svm.classes() > 0;
    for (int fold = -1; fold < config.folds; ++fold) {
      std::vector<size_t> inside, outside;
      for (size_t i = 0; i < labels_.size(); ++i) {
        (fold_of.at(instances_[i]) == fold ? outside : inside).push_back(i);
      }
      Decider improved = base;
      if (corrected && !inside.empty()) improved.correction = Correct(base, inside);
      for (const size_t i : outside) held_out[i] = Predict(improved, i);
      if (fold < 0) out.improved.model.deciders[d] = std::move(improved);
    }
    out.improved.held_out.push_back(std::move(held_out));
  }
  for (size_t i = 0; i < labels_.size(); ++i) {
    out.before.push_back(Predict(model_.deciders.front(), i));
  }
  return out;
}

}  // namespace beckon::perception
