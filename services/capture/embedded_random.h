// Random numbers of the embedded scene: the same seed gives the same bytes, whatever the standard
// library.
#pragma once

#include <cstdint>
#include <random>

namespace beckon::capture {

/// A seeded engine (std::mt19937_64, whose numbers the standard fixes) with distributions of our
/// own.
class Random {
 public:
  explicit Random(uint64_t seed) : engine_(Mix(seed)) {}

  /// 0 .. 1.
  double Unit() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  double Uniform(double low, double high) { return low + (high - low) * Unit(); }
  /// low .. high, both included.
  int Int(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<uint64_t>(high - low + 1));
  }
  bool Chance(double probability) { return Unit() < probability; }
  /// About normal, mean 0, deviation 1, never beyond 3.5: the sum of four uniforms.
  float Normal() {
    const uint64_t bits = engine_();
    const double sum = static_cast<double>((bits & 0xffff) + (bits >> 16 & 0xffff) +
                                           (bits >> 32 & 0xffff) + (bits >> 48));
    return static_cast<float>((sum - 131070.0) * (1.7320508075688772 / 65536.0));
  }
  uint64_t Seed() { return engine_(); }

  /// A well-spread seed from a seed and an index (Steele et al., SplitMix64).
  static uint64_t Mix(uint64_t seed, uint64_t index = 0) {
    uint64_t z = seed + 0x9e3779b97f4a7c15ull * (index + 1);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace beckon::capture
