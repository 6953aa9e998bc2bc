// Candidate grasps of a fitted superquadric for a parallel gripper.
#include "services/pose/grasps.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace beckon::pose {
namespace {

// The shape as a gripper sees it: two horizontal principal directions and the vertical, with half
// widths.
struct Standing {
  Eigen::Vector3d horizontal[2];
  Eigen::Vector3d up;
  double half_width[2];
  double half_height;
  double bottom_m, top_m;  // above the table
};

Standing StandOn(const Superquadric& shape, const Plane& table) {
  Standing s;
  s.up = table.normal;
  const Eigen::Matrix3d& R = shape.X_FO.linear();
  int upright = 0;
  (R.transpose() * s.up).cwiseAbs().maxCoeff(&upright);
  const Eigen::Vector3d axis = R.col((upright + 1) % 3);
  s.horizontal[0] = (axis - s.up * s.up.dot(axis)).normalized();
  s.horizontal[1] = s.up.cross(s.horizontal[0]);
  for (int i = 0; i < 2; ++i) s.half_width[i] = HalfWidth(shape, s.horizontal[i]);
  s.half_height = HalfWidth(shape, s.up);
  const double middle = table.Distance(shape.X_FO.translation());
  s.bottom_m = middle - s.half_height;
  s.top_m = middle + s.half_height;
  return s;
}

// Angle between `direction` and the outward normal where a ray from inside the shape leaves it.
double SlipAngle(const Superquadric& shape, const Eigen::Vector3d& from_F,
                 const Eigen::Vector3d& direction_F) {
  const Eigen::Vector3d from = shape.X_FO.inverse() * from_F;
  const Eigen::Vector3d direction = shape.X_FO.linear().transpose() * direction_F;
  double inside = 0, outside = 2 * shape.semi_axes.sum() + from.norm();
  if (Gauge(shape, from) >= 1) return std::numbers::pi;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (inside + outside);
    (Gauge(shape, from + middle * direction) < 1 ? inside : outside) = middle;
  }
  const double cosine = NormalAt(shape, from + inside * direction).dot(direction);
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

// The grasp with its tips around `tips_F`; none where the gripper cannot.
std::optional<GraspCandidate> Close(const Superquadric& shape, const Eigen::Vector3d& tips_F,
                                    const Eigen::Vector3d& approach_F,
                                    const Eigen::Vector3d& closing_F, double half_width,
                                    const GripperConfig& gripper) {
  GraspCandidate grasp;
  grasp.opening_m = 2 * (half_width + gripper.clearance_m);
  if (grasp.opening_m > gripper.max_opening_m) return std::nullopt;
  if (SlipAngle(shape, tips_F, closing_F) > gripper.max_slip_rad ||
      SlipAngle(shape, tips_F, -closing_F) > gripper.max_slip_rad) {
    return std::nullopt;
  }
  grasp.X_FG.linear().col(0) = closing_F;
  grasp.X_FG.linear().col(1) = approach_F.cross(closing_F);
  grasp.X_FG.linear().col(2) = approach_F;
  grasp.X_FG.translation() = tips_F;
  const double margin = (gripper.max_opening_m - grasp.opening_m) / gripper.max_opening_m;
  const double off_centre = (tips_F - shape.X_FO.translation()).norm();
  const double closeness = 1 / (1 + off_centre / gripper.finger_depth_m);
  grasp.score = std::clamp(0.5 * margin + 0.5 * closeness, 0.0, 1.0);
  return grasp;
}

}  // namespace

std::vector<GraspCandidate> ProposeGrasps(const Superquadric& shape, const Plane& table_F,
                                          const GripperConfig& gripper) {
  const Standing s = StandOn(shape, table_F);
  const Eigen::Vector3d centre = shape.X_FO.translation();
  const double middle_m = table_F.Distance(centre);
  std::vector<GraspCandidate> grasps;
  const auto add = [&](const std::optional<GraspCandidate>& grasp) {
    if (grasp) grasps.push_back(*grasp);
  };

  // From above: the tips as deep as the fingers reach, at best level with the centre, clear of the
  // table.
  const double tip_m = std::max({s.top_m - gripper.finger_depth_m, middle_m, gripper.clearance_m});
  if (tip_m < s.top_m) {
    for (int i = 0; i < 2; ++i) {
      add(Close(shape, centre + (tip_m - middle_m) * s.up, -s.up, s.horizontal[i], s.half_width[i],
                gripper));
    }
  }

  // From the side: level with the centre, the tips at the centre or as far in as the fingers reach.
  const bool tall = s.top_m - std::max(s.bottom_m, 0.0) >= gripper.min_side_height_m;
  if (tall && middle_m - gripper.finger_half_width_m >= gripper.clearance_m) {
    for (int i = 0; i < 2; ++i) {
      const double short_of_centre = std::max(s.half_width[1 - i] - gripper.finger_depth_m, 0.0);
      for (const double side : {1.0, -1.0}) {
        const Eigen::Vector3d approach = side * s.horizontal[1 - i];
        add(Close(shape, centre - short_of_centre * approach, approach, s.horizontal[i],
                  s.half_width[i], gripper));
      }
    }
  }
  std::stable_sort(grasps.begin(), grasps.end(),
                   [](const auto& a, const auto& b) { return a.score > b.score; });
  return grasps;
}

}  // namespace beckon::pose
