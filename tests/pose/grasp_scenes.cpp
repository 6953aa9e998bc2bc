// Objects on a table for the tests of grasps, and what a gripper fills.
#include "tests/pose/grasp_scenes.h"

#include <array>
#include <cmath>

namespace beckon::pose {

FitResult Known(const Superquadric& shape, double sigma_m, double sigma_rad) {
  FitResult fit;
  fit.shape = shape;
  fit.converged = true;
  fit.covariance.diagonal().head<3>().setConstant(sigma_m * sigma_m);
  fit.covariance.diagonal().tail<3>().setConstant(sigma_rad * sigma_rad);
  return fit;
}

std::vector<GraspCandidate> Propose(const Superquadric& shape, std::span<const Obstacle> others) {
  return ProposeGrasps(Known(shape), {}, kTable, {others}, kGripper);
}

Superquadric RandomShape(std::mt19937& engine) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  Eigen::Vector3d semi_axes;
  for (const int i : {0, 1, 2}) semi_axes[i] = uniform(0.01, i == 2 ? 0.12 : 0.06);
  const double e1 = uniform(0.1, 1.5), e2 = uniform(0.1, 1.5), turn = uniform(-3, 3);
  Superquadric shape = MakeShape(semi_axes, e1, e2, {0, 0, 0}, {0, 0, turn});
  const double lean = std::array{0.0, M_PI / 2, uniform(-0.4, 0.4)}[engine() % 3];
  shape.X_FO.linear() =
      shape.X_FO.linear() * Eigen::AngleAxisd(lean, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const double x = uniform(-1, 1), y = uniform(-1, 1);
  shape.X_FO.translation() = Eigen::Vector3d(x, y, HalfWidth(shape, Eigen::Vector3d::UnitZ()));
  return shape;
}

Obstacle ObstacleOf(const Superquadric& shape, int points) {
  return MakeObstacle(WholeSurface(shape, points), Known(shape), kGripper.clearance_m);
}

bool InGripper(const GraspCandidate& g, const Eigen::Vector3d& p) {
  const double back = kGripper.finger_depth_m + kGripper.approach_m;
  const double outside = std::abs(p.x()) - g.opening_m / 2;
  const bool in_finger = outside > 0 && outside < kGripper.finger_thickness_m &&
                         std::abs(p.y()) < kGripper.finger_half_width_m && p.z() < 0 &&
                         p.z() > -back;
  const bool in_palm = std::abs(p.x()) < kGripper.palm_width_m / 2 &&
                       std::abs(p.y()) < kGripper.palm_thickness_m / 2 &&
                       p.z() < -kGripper.finger_depth_m && p.z() > -back - kGripper.palm_depth_m;
  return in_finger || in_palm;
}

}  // namespace beckon::pose
