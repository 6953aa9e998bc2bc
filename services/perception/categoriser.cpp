// View -> cues -> classifiers -> decision.
#include "services/perception/categoriser.h"

#include <algorithm>

#include "services/base/utime.h"
#include "services/perception/categoriser_confidence.h"
#include "services/perception/cue_interface.h"
#include "services/perception/cue_shape_measures.h"
#include "services/perception/model_file.h"

namespace beckon::perception {
namespace {

/// Says so where the object spans too much; a few stray points do not count.
std::string TooLarge(const CueView& view) {
  float extent = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::VectorXf along = view.points_T.row(axis);
    const std::vector<float> values(along.data(), along.data() + along.size());
    extent = std::max(extent, Quantile(values, 0.98F) - Quantile(values, 0.02F));
  }
  if (!(extent > Categoriser::kMaxExtent_m)) return {};
  return "expected an object of at most 1 m, found one that spans " + std::to_string(extent) + " m";
}

}  // namespace

Result<Categoriser> Categoriser::Load(const std::string& path) {
  Result<Model> model = ReadModelFile(path);
  if (!model) return model.error();
  return Categoriser(std::move(*model));
}

Categoriser::Categoriser(Model model)
    : threshold_(model.deciders.front().threshold), unknown_prior_(model.unknown_prior) {
  for (const CueModel& cue : model.cues) cues_.push_back(MakeCue(cue.name));
  model_ = std::make_unique<const Model>(std::move(model));
  decider_ = &model_->deciders.front();
  used_ = decider_->cues;
}

Categoriser::~Categoriser() = default;
Categoriser::Categoriser(Categoriser&&) noexcept = default;
Categoriser& Categoriser::operator=(Categoriser&&) noexcept = default;

Status Categoriser::UseCues(const std::string& names) {
  std::vector<std::string> known;
  for (const CueModel& cue : model_->cues) known.push_back(cue.name);
  const auto wanted = ParseCueNames(names, known);
  if (!wanted) return Error{"the model has " + wanted.error().message};
  used_.clear();
  for (uint32_t i = 0; i < known.size(); ++i) {
    if (std::find(wanted->begin(), wanted->end(), known[i]) != wanted->end()) used_.push_back(i);
  }
  decider_ = FindDecider(*model_, used_);
  if (decider_ == nullptr) decider_ = &model_->deciders.front();
  threshold_ = decider_->threshold;
  return {};
}

Categorisation Categoriser::Categorise(const ObjectView& view) const {
  Categorisation out;
  if (CountPoints(view) < kMinPoints) {
    out.reason = "expected at least " + std::to_string(kMinPoints) + " points with depth, found " +
                 std::to_string(CountPoints(view));
    return out;
  }
  const Stopwatch all;
  const CueView prepared = MakeCueView(view);
  out.reason = TooLarge(prepared);
  if (!out.reason.empty()) return out;
  std::vector<std::vector<float>> by_cue(decider_->cues.size());
  for (const uint32_t i : used_) {
    const Stopwatch one;
    const CueModel& learnt = model_->cues[i];
    std::vector<float> said;
    if (cues_[i]->CanSee(prepared)) {
      said = learnt.classifier.Probabilities(
          learnt.encoder.Encode(*cues_[i], cues_[i]->Describe(prepared)));
    }
    const auto slot = std::find(decider_->cues.begin(), decider_->cues.end(), i);
    by_cue[static_cast<size_t>(slot - decider_->cues.begin())] = said;
    out.cues.push_back({learnt.name, std::move(said), one.Milliseconds()});
  }
  std::vector<float> decided = Decide(*decider_, std::move(by_cue));
  out.milliseconds = all.Milliseconds();
  if (decided.empty()) {
    out.reason = "expected colour, which is all that the chosen cues look at, found none";
    return out;
  }
  ApplyUnknownPrior(model_->categories, unknown_prior_, decided);
  out.confidence = RenyiConfidence(decided);
  out.ask_user = out.confidence <= threshold_;
  for (size_t c = 0; c < decided.size(); ++c) {
    out.probabilities.emplace_back(model_->categories[c], decided[c]);
  }
  std::stable_sort(out.probabilities.begin(), out.probabilities.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  out.milliseconds = all.Milliseconds();
  return out;
}

const std::vector<std::string>& Categoriser::categories() const { return model_->categories; }

}  // namespace beckon::perception
