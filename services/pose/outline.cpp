// The visible outline of a cloud as planes through the viewpoint.
#include "services/pose/outline.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace beckon::pose {

std::vector<TangentPlane> OutlinePlanes(const PointList& points_F,
                                        const Eigen::Vector3d& viewpoint_F,
                                        const std::optional<Plane>& table_F, int count,
                                        double pixel_rad, double table_margin_m) {
  std::vector<TangentPlane> planes;
  Eigen::Vector3d sight = Eigen::Vector3d::Zero();
  for (const auto& p : points_F) sight += p - viewpoint_F;
  if (count <= 0 || sight.norm() < 1e-6) return planes;
  sight.normalize();
  const Eigen::Vector3d right = sight.unitOrthogonal(), down = sight.cross(right);

  struct Touch {
    double slope = -1e300;  // of the ray to the outermost point
    size_t point = 0;
  };
  std::vector<Touch> touches(static_cast<size_t>(count));
  std::vector<Eigen::Vector2d> turns;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count;
    turns.emplace_back(std::cos(angle), std::sin(angle));
  }
  for (size_t i = 0; i < points_F.size(); ++i) {
    const Eigen::Vector3d ray = points_F[i] - viewpoint_F;
    const double depth = ray.dot(sight);
    if (depth <= 1e-6) return {};  // the viewpoint is among the points: there is no outline
    const Eigen::Vector2d image(ray.dot(right) / depth, ray.dot(down) / depth);
    for (size_t k = 0; k < turns.size(); ++k) {
      const double slope = turns[k].dot(image);
      if (slope > touches[k].slope) touches[k] = {slope, i};
    }
  }
  for (size_t k = 0; k < turns.size(); ++k) {
    if (table_F && table_F->Distance(points_F[touches[k].point]) < table_margin_m) continue;
    const double slope = touches[k].slope + 0.5 * pixel_rad;
    const Eigen::Vector3d normal = turns[k].x() * right + turns[k].y() * down - slope * sight;
    planes.push_back({normal.normalized()});
  }
  return planes;
}

}  // namespace beckon::pose
