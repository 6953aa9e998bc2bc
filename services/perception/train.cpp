// Vocabularies, machines and the decision, each held-out instance by instance.
#include "services/perception/train.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "services/perception/bag_of_words.h"
#include "services/perception/categoriser.h"

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

struct DeciderPlan {
  std::string name;
  std::vector<uint32_t> cues;
  std::vector<float> weights;  // that it blends them with; empty: it does not
};

/// One over all cues, one over the dissertation's alone as it has it, and each cue by itself.
std::vector<DeciderPlan> PlanDeciders(const Model& model) {
  DeciderPlan all{"all cues", {}, {}}, dissertation{"the dissertation's cues", {}, {}};
  std::vector<DeciderPlan> alone;
  const auto& three = DissertationCues();
  for (uint32_t c = 0; c < model.cues.size(); ++c) {
    const std::string& name = model.cues[c].name;
    all.cues.push_back(c);
    all.weights.push_back(MakeCue(name)->weight());
    if (std::find(three.begin(), three.end(), name) != three.end()) dissertation.cues.push_back(c);
    alone.push_back({name, {c}, {}});
  }
  std::vector<DeciderPlan> plans;
  const bool has_three = dissertation.cues.size() == three.size();
  if (!has_three || all.cues.size() > three.size()) plans.push_back(all);
  if (all.cues.size() == 1) return plans;
  if (has_three) plans.push_back(dissertation);
  plans.insert(plans.end(), alone.begin(), alone.end());
  return plans;
}

}  // namespace

struct Trainer::State {
  TrainConfig config;
  std::mt19937 random;
  std::vector<std::unique_ptr<const Cue>> cues;
  std::vector<std::vector<Descriptors>> samples;   // by cue, one entry a view
  std::vector<CueEncoder> encoders;                // by cue
  std::vector<ViewFeatures> features;              // one entry a view
  std::vector<std::string> categories, instances;  // of each view

  Status CheckClasses(const std::set<std::string>& names) const;
  /// The views' labels and folds, without features.
  SvmTrainingSet LabelAndFold(const std::vector<std::string>& names) const;
  /// The views that the cue sees; nothing where they are too few to hold any out.
  std::optional<SvmTrainingSet> SeenBy(size_t cue, const SvmTrainingSet& all) const;
  /// Adds the cue to the model and what it said to `by_cue`; false: stopped.
  bool TrainCue(size_t cue, const SvmTrainingSet& all, const StepProgress& done,
                std::vector<std::vector<std::vector<float>>>& by_cue, TrainOutcome& out);
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

Trainer::Trainer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Trainer::~Trainer() = default;
Trainer::Trainer(Trainer&&) noexcept = default;

Result<Trainer> Trainer::Make(const TrainConfig& config) {
  auto state = std::make_unique<State>();
  state->config = config;
  state->random.seed(static_cast<uint32_t>(config.seed ^ config.seed >> 32));
  std::vector<std::string> known;
  for (const auto& cue : MakeCues()) known.push_back(cue->name());
  const auto wanted = ParseCueNames(config.cues, known);
  if (!wanted) return Error{"there is " + wanted.error().message};
  for (const std::string& name : *wanted) state->cues.push_back(MakeCue(name));
  state->samples.resize(state->cues.size());
  return Trainer(std::move(state));
}

std::vector<size_t> Trainer::ChooseSamples(size_t count) {
  std::vector<size_t> order(count);
  for (size_t i = 0; i < count; ++i) order[i] = i;
  for (size_t i = count; i > 1; --i) std::swap(order[i - 1], order[state_->random() % i]);
  order.resize(std::min(count, static_cast<size_t>(state_->config.vocabulary_views)));
  std::sort(order.begin(), order.end());
  return order;
}

Result<ViewSample> Trainer::Sample(const ObjectView& view) const {
  if (Status status = CheckPoints(view); !status) return status.error();
  const CueView prepared = MakeCueView(view);
  ViewSample sample;
  for (const auto& cue : state_->cues) {
    sample.emplace_back(0, cue->dimension());
    if (cue->encoding() == Encoding::kDense || !cue->CanSee(prepared)) continue;
    sample.back() = Thin(cue->Describe(prepared), state_->config.descriptors_per_view);
  }
  return sample;
}

void Trainer::Add(ViewSample sample) {
  for (size_t c = 0; c < sample.size(); ++c) state_->samples[c].push_back(std::move(sample[c]));
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

Result<ViewFeatures> Trainer::Describe(const ObjectView& view) const {
  if (Status status = CheckPoints(view); !status) return status.error();
  const CueView prepared = MakeCueView(view);
  ViewFeatures features;
  for (size_t c = 0; c < state_->cues.size(); ++c) {
    const Cue& cue = *state_->cues[c];
    features.emplace_back();
    if (!cue.CanSee(prepared)) continue;
    features.back() = state_->encoders[c].Encode(cue, cue.Describe(prepared));
  }
  return features;
}

void Trainer::Add(ViewFeatures features, const std::string& category, const std::string& instance) {
  state_->features.push_back(std::move(features));
  state_->categories.push_back(category);
  state_->instances.push_back(category + "/" + instance);
}

std::optional<SvmTrainingSet> Trainer::State::SeenBy(size_t cue, const SvmTrainingSet& all) const {
  SvmTrainingSet set;
  set.classes = all.classes;
  set.fold_count = all.fold_count;
  std::vector<std::set<int>> folds(static_cast<size_t>(all.classes));
  for (size_t i = 0; i < features.size(); ++i) {
    if (!features[i][cue]) continue;
    set.features.push_back(*features[i][cue]);
    set.labels.push_back(all.labels[i]);
    set.folds.push_back(all.folds[i]);
    folds[static_cast<size_t>(all.labels[i])].insert(all.folds[i]);
  }
  for (const auto& of_class : folds) {
    if (of_class.size() < 2) return std::nullopt;
  }
  return set;
}

bool Trainer::State::TrainCue(size_t cue, const SvmTrainingSet& all, const StepProgress& done,
                              std::vector<std::vector<std::vector<float>>>& by_cue,
                              TrainOutcome& out) {
  const auto set = SeenBy(cue, all);
  if (!set) {
    out.notes.push_back("the cue " + cues[cue]->name() +
                        " is left out: expected it to see two objects of each category, such as "
                        "views with colour, found fewer");
    return true;
  }
  auto trained = TrainSvm(*set, {config.cost, config.gamma_scale, config.threads}, done);
  if (!trained) return false;
  size_t next = 0;
  for (size_t i = 0; i < features.size(); ++i) {
    by_cue[i].emplace_back();
    if (features[i][cue]) by_cue[i].back() = std::move(trained->out_of_fold[next++]);
  }
  out.model.cues.push_back(
      {cues[cue]->name(), std::move(encoders[cue]), std::move(trained->classifier)});
  return true;
}

Result<TrainOutcome> Trainer::Finish(const Watch& watch) {
  State& s = *state_;
  const std::set<std::string> names(s.categories.begin(), s.categories.end());
  if (Status status = s.CheckClasses(names); !status) return status.error();
  const auto step = [&](const std::string& what) -> StepProgress {
    if (!watch) return {};
    return [&watch, what](size_t done, size_t total) { return watch(what, done, total); };
  };
  const Error stopped{"stopped on request; no model was written"};

  TrainOutcome out;
  out.model.categories.assign(names.begin(), names.end());
  out.model.seed = s.config.seed;
  out.model.unknown_prior = static_cast<float>(s.config.unknown_prior);
  const SvmTrainingSet set = s.LabelAndFold(out.model.categories);
  std::vector<std::vector<std::vector<float>>> by_cue(s.categories.size());
  for (size_t c = 0; c < s.cues.size(); ++c) {
    if (!s.TrainCue(c, set, step("training the machines of " + s.cues[c]->name()), by_cue, out)) {
      return stopped;
    }
  }
  if (out.model.cues.empty()) {
    return Error{
        "none of the cues sees two objects of each category; give views with colour, or "
        "other cues with --cues"};
  }
  for (const DeciderPlan& plan : PlanDeciders(out.model)) {
    auto trained = TrainDecider(s.config, out.model.categories, plan.cues, plan.weights, by_cue,
                                set, step("training the decision over " + plan.name));
    if (!trained) return stopped;
    out.model.deciders.push_back(std::move(trained->decider));
    out.held_out.push_back(std::move(trained->held_out));
  }
  return out;
}

}  // namespace beckon::perception
