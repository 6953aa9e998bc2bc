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

inline Result<TrainOutcome> TrainOnShapes(const TrainConfig& config, int instances = 8) {
  const std::vector<std::string> categories = {"Bowl", "Box", "Can"};
  std::vector<ShapeView> views;
  std::mt19937 random(11);
  for (const std::string& category : categories) {
    for (int i = 0; i < instances; ++i) views.push_back(RenderCategory(category, random));
  }
  Trainer trainer(config);
  for (const size_t i : trainer.ChooseSamples(views.size())) {
    EXPECT_TRUE(trainer.SampleView(views[i].view()));
  }
  trainer.LearnEncoders();
  for (size_t i = 0; i < views.size(); ++i) {
    const size_t of = static_cast<size_t>(instances);
    EXPECT_TRUE(trainer.Add(views[i].view(), categories[i / of], std::to_string(i % of)));
  }
  return trainer.Finish([](const std::string&) {});
}

inline const TrainOutcome& TrainedOnShapes() {
  static const TrainOutcome outcome = *TrainOnShapes(SmallTraining());
  return outcome;
}

}  // namespace beckon::perception
