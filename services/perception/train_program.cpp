// Folder in, model and card out.
#include "services/perception/train_program.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "services/base/utime.h"
#include "services/perception/model_file.h"
#include "services/perception/train_base.h"
#include "services/perception/train_card.h"
#include "services/perception/train_figures.h"
#include "services/perception/train_reading.h"

namespace beckon::perception {
namespace {

std::string Describe(const std::vector<ViewRecord>& records) {
  std::set<std::string> categories, instances;
  for (const ViewRecord& record : records) {
    categories.insert(record.category);
    instances.insert(record.category + "/" + record.instance);
  }
  return std::to_string(records.size()) + " views of " + std::to_string(instances.size()) +
         " instances in " + std::to_string(categories.size()) + " categories";
}

Error Stopped() { return {"stopped on request; no model was written"}; }

/// Hands the trainer all views; false where it was told to stop. `records` loses those skipped.
bool FeedTrainer(std::vector<ViewRecord>& records, int threads, Trainer& trainer,
                 Progress& progress, Skipped& skipped) {
  std::vector<ViewRecord> chosen;
  for (const size_t i : trainer.ChooseSamples(records.size())) chosen.push_back(records[i]);
  std::vector<std::optional<ViewSample>> samples;
  if (!ReadAll<ViewSample>(
          chosen, "reading views for the vocabularies", threads,
          [&](const ObjectView& view) { return trainer.Sample(view); }, progress, samples,
          skipped)) {
    return false;
  }
  for (auto& sample : samples) {
    if (sample) trainer.Add(std::move(*sample));
  }
  if (!progress.Tell("learning the vocabularies", 0, 0)) return false;
  trainer.LearnEncoders();
  std::vector<std::optional<ViewFeatures>> features;
  if (!ReadAll<ViewFeatures>(
          records, "describing the views", threads,
          [&](const ObjectView& view) { return trainer.Describe(view); }, progress, features,
          skipped)) {
    return false;
  }
  KeepMade(records, features);
  for (size_t i = 0; i < records.size(); ++i) {
    trainer.Add(std::move(*features[i]), records[i].category, records[i].instance);
  }
  return true;
}

/// Says which sub-folders gave nothing.
void NoteEmptyCategories(const std::string& folder, const std::vector<ViewRecord>& used,
                         std::vector<std::string>& notes) {
  std::set<std::string> empty;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.is_directory(error)) empty.insert(entry.path().filename().string());
  }
  for (const ViewRecord& record : used) empty.erase(record.category);
  for (const std::string& name : empty) {
    notes.push_back("the folder " + name + " holds no usable view; nothing was learnt of it");
  }
}

Result<TrainOutcome> Learn(std::vector<ViewRecord>& records, const TrainConfig& config,
                           Progress& progress, Skipped& skipped) {
  Result<Trainer> trainer = Trainer::Make(config);
  if (!trainer) return trainer.error();
  if (!FeedTrainer(records, config.threads, *trainer, progress, skipped)) return Stopped();
  auto outcome = trainer->Finish([&](const std::string& step, size_t done, size_t total) {
    return progress.Tell(step, done, total);
  });
  if (outcome) outcome->model.description = Describe(records);
  return outcome;
}

/// `before`: what the base said of the views, for comparison.
Result<TrainOutcome> Improve(const std::string& base_file, std::vector<ViewRecord>& records,
                             const TrainConfig& config, Progress& progress, Skipped& skipped,
                             std::string& before) {
  Result<Model> base = ReadModelFile(base_file);
  if (!base) return Error{"--base " + base.error().message};
  const std::string base_description = base->description;
  std::set<std::string> categories;
  for (const ViewRecord& record : records) categories.insert(record.category);
  BaseTrainer trainer(std::move(*base), {categories.begin(), categories.end()});
  std::vector<std::optional<std::vector<std::vector<float>>>> said;
  if (!ReadAll<std::vector<std::vector<float>>>(
          records, "reading the views", config.threads,
          [&](const ObjectView& view) { return trainer.Describe(view); }, progress, said,
          skipped)) {
    return Stopped();
  }
  KeepMade(records, said);
  for (size_t i = 0; i < records.size(); ++i) {
    trainer.Add(std::move(*said[i]), records[i].category, records[i].instance);
  }
  auto outcome = trainer.Finish(config, [&](const std::string& step, size_t done, size_t total) {
    return progress.Tell(step, done, total);
  });
  if (!outcome) return outcome.error();
  Model& model = outcome->improved.model;
  model.description = base_description + "; improved by " + Describe(records);
  before =
      "the base said of these views: " +
      Text(FiguresOf(Judge(outcome->before), model.categories, model.deciders.front().threshold)) +
      "\n";
  return std::move(outcome->improved);
}

Status WriteText(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::trunc);
  file << text;
  file.close();
  if (!file) return Error{path + ": cannot be written; expected a file in a folder that exists"};
  return {};
}

std::string HeldOutLines(const std::vector<ViewRecord>& records, const TrainOutcome& outcome) {
  std::string lines;
  for (size_t i = 0; i < records.size(); ++i) {
    const HeldOutPrediction& said = outcome.held_out.front()[i];
    nlohmann::ordered_json line;
    line["file"] = records[i].file;
    line["category"] = records[i].category;
    const auto best = std::max_element(said.probabilities.begin(), said.probabilities.end());
    line["predicted"] =
        said.probabilities.empty()
            ? kUnknown
            : outcome.model.categories[static_cast<size_t>(best - said.probabilities.begin())];
    line["probabilities"] = nlohmann::ordered_json::object();
    for (size_t c = 0; c < said.probabilities.size(); ++c) {
      line["probabilities"][outcome.model.categories[c]] = said.probabilities[c];
    }
    line["confidence"] = said.confidence;
    line["ask_user"] = said.confidence <= outcome.model.deciders.front().threshold;
    lines += line.dump() + "\n";
  }
  return lines;
}

void Print(const TrainOutcome& outcome, const TrainConfig& config, size_t skipped) {
  const Model& model = outcome.model;
  const Decider& decider = model.deciders.front();
  const std::vector<Judgement> judgements = Judge(outcome.held_out.front());
  for (const std::string& note : outcome.notes) std::printf("note: %s\n", note.c_str());
  std::printf("%s, %d folds over instances, %zu skipped\n\n%s\n%s\n%s\n%s\n",
              model.description.c_str(), config.folds, skipped, CueTable(outcome).c_str(),
              ConfusionTable(judgements, model.categories).c_str(),
              RiskCoverageTable(OfKnown(judgements, model.categories), decider.threshold).c_str(),
              Text(FiguresOf(judgements, model.categories, decider.threshold)).c_str());
  std::printf("temperature %.3f, threshold T %.3f\n", static_cast<double>(decider.temperature),
              static_cast<double>(decider.threshold));
}

/// Size, and the time to read it back, as perception will.
Status PrintFile(const std::string& path) {
  const Stopwatch watch;
  const auto model = ReadModelFile(path);
  if (!model) return model.error();
  const double ms = watch.Milliseconds();
  std::printf("%s: %.2f MB, loads in %.0f ms\n", path.c_str(),
              static_cast<double>(std::filesystem::file_size(path)) / 1e6, ms);
  return {};
}

}  // namespace

Status LoadTrainConfig(ConfigTable table, TrainConfig& config) {
  ConfigTable train = table.Section("train");
  train.Get("folds", config.folds, 2, 50);
  train.Get("cues", config.cues);
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
  train.Get("unknown_prior", config.unknown_prior, 0.001, 1000);
  train.Get("target_accuracy", config.target_accuracy, 0, 1);
  train.Get("threads", config.threads, 1, 64);
  return table.Finish();
}

Status RunTraining(const TrainOptions& options, const TrainConfig& config) {
  const Stopwatch watch;
  Progress progress(options.terminal, options.stopped);
  auto records = ListViews(options.data);
  if (!records) return records.error();
  progress.Say(options.data + ": " + Describe(*records));
  CardSubject subject{options.model, options.data, {}, {}, options.version, options.base};
  std::string before;
  auto outcome = options.base.empty()
                     ? Learn(*records, config, progress, subject.skipped)
                     : Improve(options.base, *records, config, progress, subject.skipped, before);
  if (!outcome) return Error{options.data + ": " + outcome.error().message};
  NoteEmptyCategories(options.data, *records, outcome->notes);
  if (Status status = WriteModelFile(options.model, outcome->model); !status) return status;
  progress.Say("done in " + std::to_string(static_cast<int>(watch.Milliseconds() / 1000)) + " s");

  Print(*outcome, config, subject.skipped.size());
  std::fputs(before.c_str(), stdout);
  if (Status status = PrintFile(options.model); !status) return status;
  const std::string card =
      options.card.empty() ? std::filesystem::path(options.model).replace_extension(".md").string()
                           : options.card;
  subject.records = *records;
  if (Status s = WriteText(card, ModelCard(subject, config, *outcome)); !s) return s;
  if (!options.jsonl.empty()) {
    if (Status s = WriteText(options.jsonl, HeldOutLines(*records, *outcome)); !s) return s;
  }
  return DrawPictures(options, Judge(outcome->held_out.front()), outcome->model.categories,
                      outcome->model.deciders.front().threshold);
}

Status DrawPictures(const TrainOptions& options, const std::vector<Judgement>& judgements,
                    const std::vector<std::string>& categories, float threshold) {
  if (!options.picture.empty()) {
    if (Status s = DrawConfusions(judgements, categories, options.picture); !s) return s;
  }
  if (options.pictures.empty()) return {};
  const std::filesystem::path folder = options.pictures;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return Error{options.pictures + ": cannot be made (" + error.message() + ")"};
  const std::vector<Judgement> known = OfKnown(judgements, categories);
  if (Status s = DrawConfusions(judgements, categories, folder / "confusions.png"); !s) return s;
  if (Status s = DrawRiskCoverage(known, threshold, folder / "risk_coverage.png"); !s) return s;
  return DrawReliability(known, folder / "reliability.png");
}

}  // namespace beckon::perception
