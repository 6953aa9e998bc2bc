// View -> cues -> classifiers -> decision.
#include "services/perception/categoriser.h"

#include <algorithm>

#include "services/base/utime.h"
#include "services/perception/categoriser_confidence.h"
#include "services/perception/cue_interface.h"
#include "services/perception/model_file.h"

namespace beckon::perception {

Result<Categoriser> Categoriser::Load(const std::string& path) {
  Result<Model> model = ReadModelFile(path);
  if (!model) return model.error();
  return Categoriser(std::move(*model));
}

Categoriser::Categoriser(Model model) : threshold_(model.threshold) {
  for (const CueModel& cue : model.cues) cues_.push_back(MakeCue(cue.name));
  model_ = std::make_unique<const Model>(std::move(model));
}

Categoriser::~Categoriser() = default;
Categoriser::Categoriser(Categoriser&&) noexcept = default;
Categoriser& Categoriser::operator=(Categoriser&&) noexcept = default;

Categorisation Categoriser::Categorise(const ObjectView& view) const {
  Categorisation out;
  if (CountPoints(view) < kMinPoints) return out;
  const Stopwatch all;
  const CueView prepared = MakeCueView(view);
  std::vector<std::vector<float>> by_cue;
  for (size_t i = 0; i < cues_.size(); ++i) {
    const Stopwatch one;
    const CueModel& learnt = model_->cues[i];
    by_cue.push_back(learnt.classifier.Probabilities(
        learnt.encoder.Encode(*cues_[i], cues_[i]->Describe(prepared))));
    out.cues.push_back({learnt.name, by_cue.back(), one.Milliseconds()});
  }
  const std::vector<float> decided = Decide(*model_, by_cue);
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
