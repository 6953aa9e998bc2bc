// What tells one thing from another of its kind: how large it is and how it is coloured. For
// recognising an object that somebody named before.
#pragma once

#include <Eigen/Core>
#include <array>

#include "services/perception/object_view.h"

namespace beckon::perception {

struct InstanceLook {
  static constexpr int kCells = 64;  // 4 x 4 x 4 of red, green and blue

  double height_m = 0;  // along the table's normal, without the outermost 2 % of the points
  double width_m = 0;   // the longest edge along the table, likewise
  std::array<float, kCells> colours{};  // shares, sum 1; zeros where there is no colour
  int n_points = 0;
};

/// Fewer than Categoriser::kMinPoints points with depth make no look: n_points stays 0.
InstanceLook LookAtInstance(const ObjectView& view);

/// How different two looks are, >= 0: the differences of sizes and colours in units of what two
/// views of one thing commonly differ by. Infinite where either is none.
double Difference(const InstanceLook& a, const InstanceLook& b);

}  // namespace beckon::perception
