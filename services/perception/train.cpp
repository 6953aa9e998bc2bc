// Vocabularies, machines and the decision, each held-out instance by instance.
#include "services/perception/train.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "services/perception/bag_of_words.h"
#include "services/perception/categoriser.h"
#include "services/perception/categoriser_confidence.h"
#include "services/perception/train_report.h"
#include "services/perception/train_svm.h"

namespace beckon::perception {
namespace {

int Words(const TrainConfig& config, const std::string& cue) {
  if (cue == "sift") return config.sift_words;
  if (cue == "hog") return config.hog_words;
  return config.fpfh_words;
}

/// An even choice of at most `most` rows.
Descriptors Thin(const Descriptors& all, int most) {
  if (all.rows() <= most) return all;
  Descriptors some(most, all.cols());
  for (int i = 0; i < most; ++i) some.row(i) = all.row(i * all.rows() / most);
  return some;
}

Descriptors Stack(const std::vector<Descriptors>& parts, int columns) {
  int64_t rows = 0;
  for (const Descriptors& part : parts) rows += part.rows();
  Descriptors all(rows, columns);
  rows = 0;
  for (const Descriptors& part : parts) {
    all.middleRows(rows, part.rows()) = part;
    rows += part.rows();
  }
  return all;
}

Status CheckPoints(const ObjectView& view) {
  if (CountPoints(view) >= Categoriser::kMinPoints) return {};
  return Error{"expected at least " + std::to_string(Categoriser::kMinPoints) +
               " points with depth, found " + std::to_string(CountPoints(view))};
}

}  // namespace

struct Trainer::State {
  TrainConfig config;
  std::mt19937 random;
  std::vector<std::unique_ptr<const Cue>> cues = MakeCues();
  std::vector<std::vector<Descriptors>> samples;   // by cue, one entry a view
  std::vector<CueEncoder> encoders;                // by cue
  std::vector<std::vector<Features>> features;     // by cue, one entry a view
  std::vector<std::string> categories, instances;  // of each view

  Status CheckClasses(const std::set<std::string>& names) const;
  /// The views' labels and folds, without features.
  SvmTrainingSet LabelAndFold(const std::vector<std::string>& names) const;
};

Status Trainer::State::CheckClasses(const std::set<std::string>& names) const {
  if (names.size() < 2) {
    return Error{"expected views of at least two categories, found " +
                 (names.empty() ? std::string("none") : "only " + *names.begin()) +
                 "; give a folder with a sub-folder a category"};
  }
  for (const std::string& name : names) {
    std::set<std::string> distinct;
    for (size_t i = 0; i < categories.size(); ++i) {
      if (categories[i] == name) distinct.insert(instances[i]);
    }
    if (distinct.size() < 2) {
      return Error{"expected at least two instances of each category, found one of " + name +
                   "; add another object of it, or leave the category out"};
    }
  }
  return {};
}

SvmTrainingSet Trainer::State::LabelAndFold(const std::vector<std::string>& names) const {
  std::map<std::string, std::string> category_of;
  for (size_t i = 0; i < instances.size(); ++i) category_of[instances[i]] = categories[i];
  const std::map<std::string, int> folds = DealFolds(category_of, config.folds, config.seed);
  SvmTrainingSet set;
  set.classes = static_cast<int>(names.size());
  set.fold_count = config.folds;
  for (size_t i = 0; i < categories.size(); ++i) {
    const auto at = std::lower_bound(names.begin(), names.end(), categories[i]);
    set.labels.push_back(static_cast<int>(at - names.begin()));
    set.folds.push_back(folds.at(instances[i]));
  }
  return set;
}

Trainer::Trainer(const TrainConfig& config) : state_(std::make_unique<State>()) {
  state_->config = config;
  state_->random.seed(static_cast<uint32_t>(config.seed ^ config.seed >> 32));
  state_->samples.resize(state_->cues.size());
  state_->features.resize(state_->cues.size());
}

Trainer::~Trainer() = default;

std::vector<size_t> Trainer::ChooseSamples(size_t count) {
  std::vector<size_t> order(count);
  for (size_t i = 0; i < count; ++i) order[i] = i;
  for (size_t i = count; i > 1; --i) std::swap(order[i - 1], order[state_->random() % i]);
  order.resize(std::min(count, static_cast<size_t>(state_->config.vocabulary_views)));
  std::sort(order.begin(), order.end());
  return order;
}

Status Trainer::SampleView(const ObjectView& view) {
  if (Status status = CheckPoints(view); !status) return status;
  const CueView prepared = MakeCueView(view);
  for (size_t c = 0; c < state_->cues.size(); ++c) {
    if (state_->cues[c]->encoding() == Encoding::kDense) continue;
    state_->samples[c].push_back(
        Thin(state_->cues[c]->Describe(prepared), state_->config.descriptors_per_view));
  }
  return {};
}

void Trainer::LearnEncoders() {
  for (size_t c = 0; c < state_->cues.size(); ++c) {
    const Cue& cue = *state_->cues[c];
    CueEncoder encoder;
    const Descriptors all = Stack(state_->samples[c], cue.dimension());
    if (cue.encoding() == Encoding::kBag) {
      encoder.vocabulary = LearnVocabulary(all, Words(state_->config, cue.name()),
                                           state_->config.kmeans_iterations, state_->random);
    } else if (cue.encoding() == Encoding::kStatistics && all.rows() > 0) {
      encoder.quantiles = LearnQuantiles(all);
    }
    state_->encoders.push_back(std::move(encoder));
  }
  state_->samples.clear();
}

Status Trainer::Add(const ObjectView& view, const std::string& category,
                    const std::string& instance) {
  if (Status status = CheckPoints(view); !status) return status;
  const CueView prepared = MakeCueView(view);
  for (size_t c = 0; c < state_->cues.size(); ++c) {
    const Cue& cue = *state_->cues[c];
    state_->features[c].push_back(state_->encoders[c].Encode(cue, cue.Describe(prepared)));
  }
  state_->categories.push_back(category);
  state_->instances.push_back(category + "/" + instance);
  return {};
}

Result<TrainOutcome> Trainer::Finish(const std::function<void(const std::string&)>& progress) {
  State& s = *state_;
  const std::set<std::string> names(s.categories.begin(), s.categories.end());
  if (Status status = s.CheckClasses(names); !status) return status.error();

  TrainOutcome out;
  out.model.categories.assign(names.begin(), names.end());
  out.model.seed = s.config.seed;
  SvmTrainingSet set = s.LabelAndFold(out.model.categories);
  out.held_out.resize(s.categories.size());
  for (size_t c = 0; c < s.cues.size(); ++c) {
    progress("training the machines of " + s.cues[c]->name());
    set.features = std::move(s.features[c]);
    TrainedSvm trained = TrainSvm(set, {s.config.cost, s.config.gamma_scale});
    out.model.cues.push_back(
        {s.cues[c]->name(), std::move(s.encoders[c]), std::move(trained.classifier)});
    for (size_t i = 0; i < out.held_out.size(); ++i) {
      out.held_out[i].by_cue.push_back(std::move(trained.out_of_fold[i]));
    }
  }
  progress("training the decision");
  set.features.clear();
  for (const auto& held_out : out.held_out) set.features.push_back(StackFeatures(held_out.by_cue));
  TrainedSvm decider = TrainSvm(set, {s.config.decider_cost, s.config.decider_gamma_scale});
  out.model.decider = std::move(decider.classifier);
  std::vector<std::vector<float>> blended;
  for (size_t i = 0; i < out.held_out.size(); ++i) {
    blended.push_back(Blend(decider.out_of_fold[i], out.held_out[i].by_cue));
  }
  out.model.temperature =
      static_cast<float>(s.config.caution) * FitTemperature(blended, set.labels);
  for (size_t i = 0; i < out.held_out.size(); ++i) {
    HeldOutPrediction& held_out = out.held_out[i];
    held_out.label = set.labels[i];
    held_out.probabilities = ApplyTemperature(blended[i], out.model.temperature);
    held_out.confidence = RenyiConfidence(held_out.probabilities);
  }
  out.model.threshold = ChooseThreshold(Judge(out.held_out), s.config.target_accuracy);
  return out;
}

}  // namespace beckon::perception
