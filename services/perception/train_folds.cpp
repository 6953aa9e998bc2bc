// Folds and calibration.
#include <algorithm>
#include <cmath>
#include <random>

#include "services/perception/train.h"

namespace beckon::perception {

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
