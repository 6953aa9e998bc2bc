// Folds, calibration and checks of the training's configuration.
#include <algorithm>
#include <cmath>
#include <random>

#include "services/perception/train.h"

namespace beckon::perception {

Status Validate(const TrainConfig& config) {
  const auto within = [](const char* name, double value, double low, double high) -> Status {
    if (value >= low && value <= high) return {};
    return Error{std::string(name) + ": expected " + std::to_string(low) + " to " +
                 std::to_string(high) + ", found " + std::to_string(value)};
  };
  for (const Status& status :
       {within("folds", config.folds, 2, 50), within("sift_words", config.sift_words, 2, 5000),
        within("hog_words", config.hog_words, 2, 5000),
        within("fpfh_words", config.fpfh_words, 2, 5000),
        within("vocabulary_views", config.vocabulary_views, 1, 100000),
        within("descriptors_per_view", config.descriptors_per_view, 1, 10000),
        within("kmeans_iterations", config.kmeans_iterations, 1, 1000),
        within("cost", config.cost, 1e-3, 1e6),
        within("gamma_scale", config.gamma_scale, 1e-3, 1e3),
        within("decider_cost", config.decider_cost, 1e-3, 1e6),
        within("decider_gamma_scale", config.decider_gamma_scale, 1e-3, 1e3),
        within("caution", config.caution, 0.1, 10),
        within("target_accuracy", config.target_accuracy, 0, 1)}) {
    if (!status) return status;
  }
  return {};
}

std::map<std::string, int> DealFolds(const std::map<std::string, std::string>& category_of_instance,
                                     int folds, uint64_t seed) {
  std::map<std::string, std::vector<std::string>> by_category;
  for (const auto& [instance, category] : category_of_instance) {
    by_category[category].push_back(instance);
  }
  std::mt19937 random(static_cast<uint32_t>(seed));
  std::map<std::string, int> out;
  for (auto& [category, instances] : by_category) {
    for (size_t i = instances.size(); i > 1; --i)
      std::swap(instances[i - 1], instances[random() % i]);
    for (size_t i = 0; i < instances.size(); ++i) {
      out[instances[i]] = static_cast<int>(i % static_cast<size_t>(folds));
    }
  }
  return out;
}

float FitTemperature(const std::vector<std::vector<float>>& probabilities,
                     const std::vector<int>& labels) {
  const auto loss = [&](double log_temperature) {
    const auto temperature = static_cast<float>(std::exp(log_temperature));
    double sum = 0;
    for (size_t i = 0; i < labels.size(); ++i) {
      const auto p = ApplyTemperature(probabilities[i], temperature);
      sum -= std::log(std::max(1e-9F, p[static_cast<size_t>(labels[i])]));
    }
    return sum;
  };
  // Golden section: the loss has one minimum in the temperature's logarithm.
  double low = std::log(0.1), high = std::log(5.0);
  constexpr double kGolden = 0.6180339887498949;
  for (int i = 0; i < 30; ++i) {
    const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    if (loss(a) < loss(b)) {
      high = b;
    } else {
      low = a;
    }
  }
  return static_cast<float>(std::exp((low + high) / 2));
}

}  // namespace beckon::perception
