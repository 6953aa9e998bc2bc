// How likely a grasp succeeds although the object's pose is known only so well.
#include "services/pose/grasp_uncertainty.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beckon::pose {
namespace {

constexpr double kSmallestTurn_rad = 1e-3;  // widens nothing that could be grasped

double StandardDeviation(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& direction) {
  return std::sqrt(std::max(direction.dot(covariance * direction), 0.0));
}

}  // namespace

PoseSpread::PoseSpread(const GraspedBody& body, const Eigen::Matrix<double, 6, 6>& covariance)
    : body_(body), position_(covariance.topLeftCorner<3, 3>()) {
  const Eigen::Matrix3d idle = IdleRotations(body.shape());
  const Eigen::Matrix3d felt = Eigen::Matrix3d::Identity() - idle * idle.transpose();
  rotation_ = felt * covariance.bottomRightCorner<3, 3>() * felt.transpose();
}

double PoseSpread::Along(const Eigen::Vector3d& direction_F) const {
  return StandardDeviation(position_, direction_F);
}

double PoseSpread::Turn(const Eigen::Vector3d& axis_F) const {
  return std::min(StandardDeviation(rotation_, axis_F), kWidestTurn_rad);
}

double PoseSpread::Closing(const Eigen::Matrix3d& R_FG) const {
  const Eigen::Vector3d closing = R_FG.col(0);
  const double place = Along(closing);
  double variance = place * place;
  for (const int about : {1, 2}) {
    const double turn = Turn(R_FG.col(about));
    if (turn < kSmallestTurn_rad) continue;
    const Eigen::Vector3d aside = std::sin(turn) * R_FG.col(3 - about);
    const Eigen::Vector3d along = std::cos(turn) * closing;
    const double gain = std::max(body_.HalfWidth(along + aside), body_.HalfWidth(along - aside)) -
                        body_.HalfWidth(closing);
    variance += std::max(gain, 0.0) * std::max(gain, 0.0);
  }
  return std::sqrt(variance);
}

double WithinProbability(double below, double above, double standard_deviation) {
  if (standard_deviation <= 0) return below >= 0 && above >= 0 ? 1 : 0;
  const double scale = std::numbers::sqrt2 * standard_deviation;
  return std::clamp(0.5 * (std::erf(above / scale) + std::erf(below / scale)), 0.0, 1.0);
}

}  // namespace beckon::pose
