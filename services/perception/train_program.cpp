// Folder in, model or judgement out.
#include "services/perception/train_program.h"

#include <cstdio>
#include <set>

#include "services/base/utime.h"
#include "services/perception/model_file.h"
#include "services/perception/train_data.h"
#include "services/perception/train_report.h"

namespace beckon::perception {
namespace {

void Say(const std::string& text) { std::fprintf(stderr, "%s\n", text.c_str()); }

/// Reads a view and hands it on; names and skips those that cannot be used.
template <typename Use>
bool UseView(const ViewRecord& record, std::set<std::string>& skipped, Use use) {
  if (skipped.contains(record.file)) return false;
  const Result<LoadedView> view = LoadView(record);
  const Status status = view ? use(view->view()) : Status(view.error());
  if (status) return true;
  Say("skipped " + record.file + ": " + status.error().message);
  skipped.insert(record.file);
  return false;
}

std::string Describe(const std::vector<ViewRecord>& records, const std::set<std::string>& skipped) {
  std::set<std::string> categories, instances;
  for (const ViewRecord& record : records) {
    if (skipped.contains(record.file)) continue;
    categories.insert(record.category);
    instances.insert(record.category + "/" + record.instance);
  }
  return std::to_string(records.size() - skipped.size()) + " views of " +
         std::to_string(instances.size()) + " instances in " + std::to_string(categories.size()) +
         " categories";
}

Status FeedTrainer(const std::vector<ViewRecord>& records, Trainer& trainer,
                   std::set<std::string>& skipped) {
  const std::vector<size_t> samples = trainer.ChooseSamples(records.size());
  Say("learning the vocabularies from " + std::to_string(samples.size()) + " views");
  for (const size_t i : samples) {
    UseView(records[i], skipped, [&](const ObjectView& view) { return trainer.SampleView(view); });
  }
  trainer.LearnEncoders();
  for (size_t i = 0; i < records.size(); ++i) {
    if (i % 500 == 0)
      Say("describing view " + std::to_string(i) + " of " + std::to_string(records.size()));
    UseView(records[i], skipped, [&](const ObjectView& view) {
      return trainer.Add(view, records[i].category, records[i].instance);
    });
  }
  return {};
}

}  // namespace

Status LoadTrainConfig(ConfigTable table, TrainConfig& config) {
  ConfigTable train = table.Section("train");
  train.Get("folds", config.folds, 2, 50);
  train.Get("sift_words", config.sift_words, 2, 5000);
  train.Get("hog_words", config.hog_words, 2, 5000);
  train.Get("fpfh_words", config.fpfh_words, 2, 5000);
  train.Get("vocabulary_views", config.vocabulary_views, 1, 100000);
  train.Get("descriptors_per_view", config.descriptors_per_view, 1, 10000);
  train.Get("kmeans_iterations", config.kmeans_iterations, 1, 1000);
  train.Get("cost", config.cost, 1e-3, 1e6);
  train.Get("gamma_scale", config.gamma_scale, 1e-3, 1e3);
  train.Get("decider_cost", config.decider_cost, 1e-3, 1e6);
  train.Get("decider_gamma_scale", config.decider_gamma_scale, 1e-3, 1e3);
  train.Get("caution", config.caution, 0.1, 10);
  train.Get("target_accuracy", config.target_accuracy, 0, 1);
  return table.Finish();
}

Status RunTraining(const TrainOptions& options, const TrainConfig& config) {
  const Stopwatch watch;
  const auto records = ListViews(options.data);
  if (!records) return records.error();
  Say(options.data + ": " + Describe(*records, {}));
  Trainer trainer(config);
  std::set<std::string> skipped;
  if (Status status = FeedTrainer(*records, trainer, skipped); !status) return status;
  Result<TrainOutcome> outcome = trainer.Finish(Say);
  if (!outcome) return Error{options.data + ": " + outcome.error().message};
  outcome->model.description = Describe(*records, skipped);
  if (Status status = WriteModelFile(options.model, outcome->model); !status) return status;

  const std::vector<Judgement> judgements = Judge(outcome->held_out);
  std::printf("%s, %d folds over instances, %zu skipped\n\n%s\n%s\n%s\n",
              outcome->model.description.c_str(), config.folds, skipped.size(),
              CueTable(*outcome).c_str(),
              ConfusionTable(judgements, outcome->model.categories).c_str(),
              RiskCoverageTable(judgements, outcome->model.threshold).c_str());
  std::printf("temperature %.3f, threshold T %.3f, %.0f s, written to %s\n",
              static_cast<double>(outcome->model.temperature),
              static_cast<double>(outcome->model.threshold), watch.Milliseconds() / 1000,
              options.model.c_str());
  if (options.picture.empty()) return {};
  return DrawConfusions(judgements, outcome->model.categories, options.picture);
}

}  // namespace beckon::perception
