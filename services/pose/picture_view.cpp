// From where a picture shows an object, and where its points come to lie.
#include "services/pose/picture_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beckon::pose {
namespace {

constexpr double kNearest_m = 1e-3;   // nearer to the camera nothing is drawn
constexpr double kFarthest_px = 2e4;  // outside any picture
constexpr double kMostElevation_rad = 20 * std::numbers::pi / 180;

Eigen::Vector3d AnyPerpendicular(const Eigen::Vector3d& direction) {
  return direction.unitOrthogonal();
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::optional<cv::Point2d> PictureView::At(const Eigen::Vector3d& p_F) const {
  const Eigen::Vector3d p_V = X_VF * p_F;
  if (!p_V.allFinite() || p_V.z() < kNearest_m) return std::nullopt;
  const Eigen::Array2d px = p_V.head<2>().array() / p_V.z() * focal_px + centre_px;
  if (!(px.abs() < kFarthest_px).all()) return std::nullopt;
  return cv::Point2d(px.x(), px.y());
}

PictureView LookAt(const Eigen::Vector3d& eye_F, const Eigen::Vector3d& target_F,
                   const Eigen::Vector3d& up_F) {
  Eigen::Vector3d forward = target_F - eye_F;
  if (!(forward.norm() > 1e-6) || !forward.allFinite()) forward = Eigen::Vector3d::UnitZ();
  forward.normalize();
  Eigen::Vector3d right = forward.cross(up_F);
  if (!(right.norm() > 1e-6)) right = AnyPerpendicular(forward);
  right.normalize();
  Pose X_FV = Pose::Identity();
  X_FV.linear() << right, forward.cross(right), forward;
  X_FV.translation() = eye_F;
  PictureView view;
  view.X_VF = X_FV.inverse();
  return view;
}

PictureView CameraView(const Eigen::Vector3d& viewpoint_F, const Eigen::Vector3d& target_F,
                       const Eigen::Vector3d& up_F) {
  const bool optical = viewpoint_F.isZero() && target_F.z() > kNearest_m;
  return optical ? PictureView{} : LookAt(viewpoint_F, target_F, up_F);
}

PictureView SideView(const Eigen::Vector3d& viewpoint_F, const Eigen::Vector3d& target_F,
                     const Eigen::Vector3d& up_F) {
  const Eigen::Vector3d to_camera = viewpoint_F - target_F;
  const double distance_m = std::max(to_camera.norm(), 0.1);
  Eigen::Vector3d level = to_camera - up_F * up_F.dot(to_camera);
  // A camera straight above: its image's right is as good a side as any.
  if (!(level.norm() > 0.05 * distance_m)) level = AnyPerpendicular(up_F);
  const double elevation_rad =
      std::clamp(std::atan2(up_F.dot(to_camera), level.norm()), 0.0, kMostElevation_rad);
  const Eigen::Vector3d side = up_F.cross(level.normalized());
  return LookAt(
      target_F + distance_m * (std::cos(elevation_rad) * side + std::sin(elevation_rad) * up_F),
      target_F, up_F);
}

void ZoomTo(const std::vector<Eigen::Vector3d>& points_F, const cv::Rect2d& area_px,
            PictureView* view) {
  Eigen::Array2d lo(1e9, 1e9), hi(-1e9, -1e9);
  for (const auto& p_F : points_F) {
    const Eigen::Vector3d p_V = view->X_VF * p_F;
    if (!p_V.allFinite() || p_V.z() < kNearest_m) continue;
    const Eigen::Array2d ray = p_V.head<2>().array() / p_V.z();
    lo = lo.min(ray);
    hi = hi.max(ray);
  }
  if ((hi < lo).any()) lo = hi = Eigen::Array2d::Zero();
  const Eigen::Array2d size = (hi - lo).max(1e-4);
  view->focal_px.setConstant(std::min(area_px.width / size.x(), area_px.height / size.y()));
  view->centre_px = Eigen::Array2d(area_px.x + area_px.width / 2, area_px.y + area_px.height / 2) -
                    0.5 * (lo + hi) * view->focal_px;
}

std::vector<Eigen::Vector3d> WithoutStrays(const std::vector<Eigen::Vector3f>& points) {
  constexpr double kStray = 6;  // times the median distance from the median
  std::vector<Eigen::Vector3d> kept;
  for (const auto& p : points) {
    if (p.allFinite()) kept.push_back(p.cast<double>());
  }
  if (kept.empty()) return kept;
  Eigen::Vector3d middle;
  std::vector<double> values(kept.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(kept.begin(), kept.end(), values.begin(),
                   [&](const auto& p) { return p[axis]; });
    middle[axis] = Median(values);
  }
  const auto distance = [&](const Eigen::Vector3d& p) { return (p - middle).norm(); };
  std::transform(kept.begin(), kept.end(), values.begin(), distance);
  const double farthest = kStray * Median(values);
  std::erase_if(kept, [&](const auto& p) { return distance(p) > farthest; });
  return kept;
}

}  // namespace beckon::pose
