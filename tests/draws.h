// Choices for tests that try many things: from a seed, or from the bytes of a fuzzer.
#pragma once

#include <Eigen/Core>
#include <bit>
#include <cstdint>
#include <iterator>
#include <limits>
#include <random>
#include <span>

namespace beckon {

/// Drawn from a seed, or from bytes while there are any and from a seed afterwards.
class Draws {
 public:
  explicit Draws(unsigned seed) : engine_(seed) {}
  explicit Draws(std::span<const uint8_t> bytes) : bytes_(bytes), engine_(1) {}

  using result_type = uint32_t;
  static constexpr uint32_t min() { return 0; }
  static constexpr uint32_t max() { return UINT32_MAX; }

  uint32_t operator()() {
    if (bytes_.empty()) return static_cast<uint32_t>(engine_());
    uint32_t value = 0;
    for (int i = 0; i < 4 && !bytes_.empty(); ++i) {
      value = value << 8 | bytes_.front();
      bytes_ = bytes_.subspan(1);
    }
    return value;
  }

  float Uniform(float lo, float hi) { return std::uniform_real_distribution<float>(lo, hi)(*this); }
  size_t Index(size_t count) { return (*this)() % count; }
  /// lo .. hi, both included.
  int Between(int lo, int hi) {
    return lo + static_cast<int>(Index(static_cast<size_t>(hi - lo) + 1));
  }
  bool OneIn(size_t n) { return Index(n) == 0; }
  template <typename Container>
  auto& Any(Container& of) {
    return *std::next(std::begin(of), static_cast<std::ptrdiff_t>(Index(std::size(of))));
  }

  /// -1 .. 1
  Eigen::Vector3f Cube() { return {Uniform(-1, 1), Uniform(-1, 1), Uniform(-1, 1)}; }
  /// NaN, infinite, huge, tiny, zero
  float OddNumber() {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInf = std::numeric_limits<float>::infinity();
    constexpr float kOdd[] = {kNan, kInf, -kInf, 1e30f, -1e30f, 1e-42f, 0, -0.0f, 3e38f};
    return Any(kOdd);
  }
  Eigen::Vector3f Odd() { return {OddNumber(), OddNumber(), OddNumber()}; }
  /// any floats there are
  Eigen::Vector3f AnyBits() {
    const auto any = [this] { return std::bit_cast<float>((*this)()); };
    return {any(), any(), any()};
  }

 private:
  std::span<const uint8_t> bytes_;
  std::mt19937 engine_;
};

}  // namespace beckon
