// From where a picture shows an object, and where its points come to lie.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "services/base/geometry.h"

namespace beckon::pose {

/// A pinhole camera (optical frame V) that looks at points of a frame F.
struct PictureView {
  Pose X_VF = Pose::Identity();
  Eigen::Array2d focal_px{525, 525};
  Eigen::Array2d centre_px{0, 0};  // where the optical axis meets the picture

  /// The pixel of a point; none behind the camera or far outside any picture.
  std::optional<cv::Point2d> At(const Eigen::Vector3d& p_F) const;
  Eigen::Vector3d eye_F() const { return X_VF.inverse().translation(); }
};

/// From `eye_F` towards `target_F`, `up_F` upwards; any upright view where those do not tell one.
PictureView LookAt(const Eigen::Vector3d& eye_F, const Eigen::Vector3d& target_F,
                   const Eigen::Vector3d& up_F);

/// As the camera saw it: a viewpoint at the origin of an optical frame keeps the image's axes.
PictureView CameraView(const Eigen::Vector3d& viewpoint_F, const Eigen::Vector3d& target_F,
                       const Eigen::Vector3d& up_F);

/// As somebody sees it who stands a quarter turn about `up_F` from the camera, with the camera's
/// side on the left: half of what he sees is hidden from the camera. At most 20 degrees above the
/// target, so that it is seen to stand.
PictureView SideView(const Eigen::Vector3d& viewpoint_F, const Eigen::Vector3d& target_F,
                     const Eigen::Vector3d& up_F);

/// Moves and zooms the picture so that the points that are in front of the camera fill `area_px`.
void ZoomTo(const std::vector<Eigen::Vector3d>& points_F, const cv::Rect2d& area_px,
            PictureView* view);

/// Leaves out what is not finite and what is far from the rest: for choosing what to zoom to.
std::vector<Eigen::Vector3d> WithoutStrays(const std::vector<Eigen::Vector3f>& points);

}  // namespace beckon::pose
