// Random numbers that are the same on every platform for the same seed.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

namespace beckon::intention {

class SeededRandom {
 public:
  explicit SeededRandom(uint64_t seed) : engine_(seed) {}

  /// In [0, 1).
  double Uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  double Between(double low, double high) { return low + (high - low) * Uniform(); }
  /// 0 .. count - 1; `count` is positive.
  int Below(int count) { return static_cast<int>(Uniform() * count); }
  bool Chance(double probability) { return Uniform() < probability; }
  /// An index in proportion to its weight, or -1 where all weights are 0.
  int Weighted(const std::vector<double>& weights) {
    double sum = 0;
    for (const double w : weights) sum += w;
    double left = Uniform() * sum;
    int last = -1;
    for (size_t i = 0; i < weights.size(); ++i) {
      if (weights[i] <= 0) continue;
      last = static_cast<int>(i);
      if ((left -= weights[i]) < 0) break;
    }
    return last;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace beckon::intention
