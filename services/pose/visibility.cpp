// What a camera above a table sees of an object's top and foot.
#include "services/pose/visibility.h"

#include <algorithm>
#include <limits>

#include "services/pose/surface.h"

namespace beckon::pose {

double SeenTop(const SpreadPoints& spread_F, const Plane& table_F) {
  std::vector<double> heights;
  for (size_t i = 0; i < spread_F.points.size(); ++i) {
    if (spread_F.weights[i] > 0.9) heights.push_back(table_F.Distance(spread_F.points[i]));
  }
  if (heights.empty()) return std::numeric_limits<double>::infinity();
  const auto top = heights.end() - 1 - static_cast<long>(heights.size() / 100);
  std::nth_element(heights.begin(), top, heights.end());
  return *top;
}

bool FootIsUnseen(const Superquadric& shape, const PointList& points_F, const Plane& table_F,
                  const Eigen::Vector3d& viewpoint_F, double gap_m) {
  constexpr int kSamples = 150;
  constexpr double kGrazing = 0.14;  // sine of the angle below which cameras see little
  std::vector<double> heights;
  for (const auto& p : points_F) heights.push_back(table_F.Distance(p));
  const auto low = heights.begin() + static_cast<long>(heights.size() / 50);
  std::nth_element(heights.begin(), low, heights.end());
  for (const Eigen::Vector3d& p : SampleSurface(shape, kSamples)) {
    if (table_F.Distance(p) > *low - gap_m) continue;
    const Eigen::Vector3d normal_F =
        shape.X_FO.linear() * NormalAt(shape, shape.X_FO.inverse() * p);
    if (normal_F.dot((p - viewpoint_F).normalized()) < -kGrazing) return true;
  }
  return false;
}

}  // namespace beckon::pose
