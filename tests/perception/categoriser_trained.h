// A small model for tests, trained once a process on rendered shapes.
#pragma once

#include <gtest/gtest.h>

#include "services/perception/train.h"
#include "tests/perception/categoriser_shapes.h"

namespace beckon::perception {

inline TrainConfig SmallTraining() {
  TrainConfig config;
  config.seed = 7;
  config.folds = 3;
  config.sift_words = 12;
  config.hog_words = 16;
  config.fpfh_words = 12;
  config.kmeans_iterations = 5;
  config.vocabulary_views = 12;
  return config;
}

/// One view, known by category and instance.
struct LabelledView {
  ShapeView shape;
  std::string category, instance;
};

inline std::vector<LabelledView> RenderViews(const std::vector<std::string>& categories,
                                             int instances, uint32_t seed) {
  std::vector<LabelledView> views;
  std::mt19937 random(seed);
  for (const std::string& category : categories) {
    for (int i = 0; i < instances; ++i) {
      views.push_back({RenderCategory(category, random), category, std::to_string(i)});
    }
  }
  return views;
}

inline Result<TrainOutcome> TrainOn(const TrainConfig& config,
                                    const std::vector<LabelledView>& views) {
  Result<Trainer> trainer = Trainer::Make(config);
  if (!trainer) return trainer.error();
  for (const size_t i : trainer->ChooseSamples(views.size())) {
    auto sample = trainer->Sample(views[i].shape.view());
    if (!sample) return sample.error();
    trainer->Add(*std::move(sample));
  }
  trainer->LearnEncoders();
  for (const LabelledView& view : views) {
    auto features = trainer->Describe(view.shape.view());
    if (!features) return features.error();
    trainer->Add(*std::move(features), view.category, view.instance);
  }
  return trainer->Finish({});
}

inline Result<TrainOutcome> TrainOnShapes(const TrainConfig& config, int instances = 8) {
  return TrainOn(config, RenderViews({"Bowl", "Box", "Can"}, instances, 11));
}

inline const TrainOutcome& TrainedOnShapes() {
  static const TrainOutcome outcome = *TrainOnShapes(SmallTraining());
  return outcome;
}

}  // namespace beckon::perception
