// Random draws that are the same with every standard library: its distributions are not.
#pragma once

#include <cstddef>
#include <random>

namespace beckon::pose {

/// Uniform in [0, 1).
inline double DrawUnit(std::mt19937& engine) {
  return static_cast<double>(engine()) / 4294967296.0;  // 2^32, one more than its largest
}

/// One of 0 .. count - 1; count > 0.
inline size_t DrawIndex(std::mt19937& engine, size_t count) {
  return static_cast<size_t>(DrawUnit(engine) * static_cast<double>(count));
}

}  // namespace beckon::pose
