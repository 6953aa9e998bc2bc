// From where, at which height and across which direction a standing object may be grasped.
#include "services/pose/grasp_directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beckon::pose {
namespace {

constexpr int kTurns = 12;                              // closing directions over the half circle
constexpr int kTurnsFromSide = 6;                       // the same from the side
constexpr double kLong = 1.3;                           // wide over narrow from which places differ
constexpr double kAcross = 0.85;                        // cosine: places along, only closing across
constexpr double kPlaces[] = {0.35, -0.35, 0.7, -0.7};  // of half the length
constexpr double kHeightStep_m = 0.015;                 // heights nearer than this are one
constexpr double kUpright = 0.9;                        // cosine

class Finder {
 public:
  Finder(const GraspedBody& body, const Standing& standing, const GripperConfig& gripper)
      : centre_(body.centre_F()), s_(standing), gripper_(gripper) {
    ideas_.reserve(128);
  }

  std::vector<GraspIdea> Find() {
    FindHeights();
    for (int i = 0; i < kTurns; ++i) {
      const double turn = i * std::numbers::pi / kTurns;
      const Eigen::Vector3d closing = std::cos(turn) * s_.narrow + std::sin(turn) * s_.wide;
      FromAbove(closing);
      if (i % (kTurns / kTurnsFromSide) == 0) FromSides(closing);
    }
    return std::move(ideas_);
  }

 private:
  void FromAbove(const Eigen::Vector3d& closing) {
    ideas_.push_back({ApproachKind::kAbove, -s_.up, closing, centre_});
    if (s_.half_wide_m < kLong * s_.half_narrow_m || closing.dot(s_.narrow) < kAcross) return;
    for (const double place : kPlaces) {
      ideas_.push_back(
          {ApproachKind::kAbove, -s_.up, closing, centre_ + place * s_.half_wide_m * s_.wide});
    }
  }

  void FromSides(const Eigen::Vector3d& closing) {
    const Eigen::Vector3d forward = s_.up.cross(closing);
    for (const double side : {1.0, -1.0}) {
      for (int i = 0; i < heights_; ++i) {
        ideas_.push_back(
            {ApproachKind::kSide, side * forward, closing, centre_ + height_m_[i] * s_.up});
      }
      const Eigen::Vector3d slope = (side * forward - s_.up) * std::numbers::sqrt2 / 2;
      ideas_.push_back({ApproachKind::kTilted, slope, closing, centre_});
    }
  }

  // Heights over the centre: as near to it as the palm's half thickness over the table allows, and
  // halfway from there to the highest and the lowest.
  void FindHeights() {
    const double middle_m = 0.5 * (s_.bottom_m + s_.top_m);
    const double half_palm_m =
        std::max(0.5 * gripper_.palm_thickness_m, gripper_.finger_half_width_m);
    const double low = s_.bottom_m + half_palm_m + gripper_.clearance_m - middle_m;
    const double high = s_.top_m - gripper_.finger_half_width_m - middle_m;
    if (low > high) return;
    const double best = std::max(low, 0.0) > high ? high : std::max(low, 0.0);
    for (const double height : {best, 0.5 * (best + high), 0.5 * (best + low)}) {
      if (heights_ > 0 && std::abs(height - best) < kHeightStep_m) continue;
      height_m_[heights_++] = height;
    }
  }

  Eigen::Vector3d centre_;
  const Standing& s_;
  const GripperConfig& gripper_;
  double height_m_[3] = {};
  int heights_ = 0;
  std::vector<GraspIdea> ideas_;
};

// The part of `v` along the table.
Eigen::Vector3d Level(const Eigen::Vector3d& v, const Eigen::Vector3d& up) {
  return (v - up * up.dot(v)).normalized();
}

}  // namespace

Standing StandOn(const GraspedBody& body, const Plane& table_F) {
  Standing s;
  s.up = table_F.normal;
  const double half_height_m = body.HalfWidth(s.up);
  const double middle_m = table_F.Distance(body.centre_F());
  s.bottom_m = std::max(middle_m - half_height_m, 0.0);
  s.top_m = middle_m + half_height_m;

  const Eigen::Matrix3d idle = IdleRotations(body.shape());
  if ((idle.transpose() * s.up).norm() > kUpright) {
    const bool x_upright = std::abs(s.up.x()) > kUpright;
    s.narrow = Level(x_upright ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX(), s.up);
  } else {
    const Eigen::Matrix3d& R = body.shape().X_FO.linear();
    int upright = 0;
    (R.transpose() * s.up).cwiseAbs().maxCoeff(&upright);
    s.narrow = Level(R.col((upright + 1) % 3), s.up);
  }
  s.wide = s.up.cross(s.narrow);
  s.half_narrow_m = body.HalfWidth(s.narrow);
  s.half_wide_m = body.HalfWidth(s.wide);
  if (s.half_narrow_m > s.half_wide_m) {
    std::swap(s.half_narrow_m, s.half_wide_m);
    s.narrow = std::exchange(s.wide, -s.narrow);
  }
  return s;
}

std::vector<GraspIdea> FindDirections(const GraspedBody& body, const Standing& standing,
                                      const GripperConfig& gripper) {
  return Finder(body, standing, gripper).Find();
}

}  // namespace beckon::pose
