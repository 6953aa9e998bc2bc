// Clouds, tables, viewpoints and rims as they should not be, and what any estimate of them must be.
#pragma once

#include <functional>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "services/pose/estimate.h"

namespace beckon::pose {

struct HostileCloud {
  std::vector<Eigen::Vector3f> points;
  std::optional<Plane> table;
  Eigen::Vector3d viewpoint = Eigen::Vector3d::Zero();
  std::vector<RimPoint> rim;
  bool hopeless = false;  // must not converge

  FitInput input() const { return {points, table, viewpoint, rim}; }
};

/// Choices, drawn from a seed, or from bytes while there are any and from a seed afterwards.
class Draws {
 public:
  explicit Draws(unsigned seed) : engine_(seed) {}
  explicit Draws(std::span<const uint8_t> bytes) : bytes_(bytes), engine_(1) {}

  using result_type = uint32_t;
  static constexpr uint32_t min() { return 0; }
  static constexpr uint32_t max() { return UINT32_MAX; }
  uint32_t operator()();

  float Uniform(float lo, float hi);
  size_t Index(size_t count);
  Eigen::Vector3f Cube();     // -1 .. 1
  Eigen::Vector3f Odd();      // NaN, infinite, huge, tiny, zero
  Eigen::Vector3f AnyBits();  // any floats there are

 private:
  std::span<const uint8_t> bytes_;
  std::mt19937 engine_;
};

/// A view of a box or a can on a table, some hundred points, and its rim.
HostileCloud SoundCloud(Draws& draws);

/// What can be done to a sound cloud, by name; it has points and a table before.
using Damage = std::function<void(HostileCloud&, Draws&)>;
const std::vector<std::pair<const char*, Damage>>& Damages();

/// What is wrong with an estimate, whatever it is of; empty where nothing is.
std::string Unsound(const FitResult& fit);
std::string Unsound(const Estimate& estimate);

}  // namespace beckon::pose
