// The upright round body that most of an object's points lie on.
#include "services/pose/round_body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

namespace beckon::pose {
namespace {

constexpr int kCircles = 60;
constexpr double kMinRadius_m = 0.015, kMaxRadius_m = 0.15;
constexpr double kSharp = 0.2;

struct Circle {
  Eigen::Vector2d centre;
  double radius = 0;

  bool Holds(const Eigen::Vector2d& p, double tolerance_m) const {
    return std::abs((p - centre).norm() - radius) < tolerance_m;
  }
};

std::optional<Circle> Through(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                              const Eigen::Vector2d& c) {
  Eigen::Matrix2d chords;
  chords << (b - a).transpose(), (c - a).transpose();
  if (std::abs(chords.determinant()) < 1e-6) return {};
  const Eigen::Vector2d right(0.5 * (b - a).squaredNorm(), 0.5 * (c - a).squaredNorm());
  const Eigen::Vector2d arm = chords.inverse() * right;
  const double radius = arm.norm();
  if (radius < kMinRadius_m || radius > kMaxRadius_m) return {};
  return Circle{a + arm, radius};
}

}  // namespace

std::optional<Superquadric> FindRoundBody(const PartsView& view, double min_share) {
  if (!view.scene.table) return {};
  Pose X_FO = Pose::Identity();
  const Eigen::Vector3d side = view.up.unitOrthogonal();
  X_FO.linear() << side, view.up.cross(side), view.up;
  std::array<Eigen::Vector2d, kBlockSize> flat;
  const int size = view.points_F.size;
  for (int i = 0; i < size; ++i) {
    flat[static_cast<size_t>(i)] = (X_FO.linear().transpose() * view.points_F.at(i)).head<2>();
  }
  const double tolerance_m = 1.5 * view.noise_m;
  std::minstd_rand engine(1);
  const auto any = [&] { return flat[engine() % static_cast<unsigned>(size)]; };
  Circle best;
  int most = 0;
  for (int trial = 0; trial < kCircles; ++trial) {
    const Eigen::Vector2d a = any(), b = any(), c = any();
    const std::optional<Circle> circle = Through(a, b, c);
    if (!circle) continue;
    int held = 0;
    for (int i = 0; i < size; ++i) held += circle->Holds(flat[static_cast<size_t>(i)], tolerance_m);
    if (held <= most) continue;
    most = held;
    best = *circle;
  }
  if (most < min_share * size) return {};
  double top = 0;
  for (int i = 0; i < size; ++i) {
    if (!best.Holds(flat[static_cast<size_t>(i)], tolerance_m)) continue;
    top = std::max(top, view.scene.table->Distance(view.points_F.at(i)));
  }
  Superquadric body;
  body.semi_axes = {best.radius, best.radius, std::max(0.5 * top, 0.002)};
  body.epsilon = {kSharp, 1};
  X_FO.translation() = X_FO.linear() * Eigen::Vector3d(best.centre.x(), best.centre.y(),
                                                       0.5 * top - view.scene.table->offset_m);
  body.X_FO = X_FO;
  return body;
}

}  // namespace beckon::pose
