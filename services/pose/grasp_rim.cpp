// Grasps of an open vessel by its rim, which a convex shape knows nothing of: from the points.
#include "services/pose/grasp_rim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace beckon::pose {
namespace {

constexpr int kDirections = 16;         // around the rim
constexpr double kLeastSeen = 0.6;      // of them
constexpr float kRimHeight_m = 0.012f;  // points this little below the highest are of the rim
constexpr float kHollow_m = 0.02f;      // those this far below it are of the inside
constexpr float kInside = 0.6f;         // of the way from the middle to the rim
constexpr double kLeastHollow = 0.05;   // of all points, those inside and below
constexpr double kMostLid = 0.01;       // of all points, those inside and level with the rim
constexpr double kPinch_m = 0.02;       // of the wall between the fingers
constexpr double kWall_m = 0.005;       // thickness
constexpr int kFewestOnWall = 6;        // points that show how the wall stands
constexpr size_t kMostPoints = 1500;    // looked at

// A point over the table: along two horizontal directions, and up.
struct Vessel {
  Eigen::Matrix3d axes;  // columns, in F
  double table_offset_m;
  std::vector<Eigen::Vector3f> points;
  float top_m = 0;
  Eigen::Vector2f middle = Eigen::Vector2f::Zero();  // of the rim
  float narrow_m = 0;                                // half of its smaller extent
};

Vessel OnTable(std::span<const Eigen::Vector3f> points_F, const Plane& table_F) {
  Vessel v;
  const Eigen::Vector3d up = table_F.normal;
  const Eigen::Vector3d start =
      std::abs(up.x()) > 0.9 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d first = (start - up * up.dot(start)).normalized();
  v.axes << first, up.cross(first), up;
  v.table_offset_m = table_F.offset_m;
  const Eigen::Matrix3f R = v.axes.transpose().cast<float>();
  const Eigen::Vector3f shift(0, 0, static_cast<float>(table_F.offset_m));
  const size_t step = points_F.size() / kMostPoints + 1;
  v.points.reserve(points_F.size() / step + 1);
  for (size_t i = 0; i < points_F.size(); i += step) {
    if (points_F[i].allFinite()) v.points.push_back(R * points_F[i] + shift);
  }
  return v;
}

// The rim's height, and its middle: that of the box around the points of that height.
void FindTop(Vessel& v) {
  std::vector<float> heights;
  for (const auto& p : v.points) heights.push_back(p.z());
  const auto top = heights.end() - 1 - static_cast<long>(heights.size() / 100);  // a few are noise
  std::nth_element(heights.begin(), top, heights.end());
  v.top_m = *top;
  Eigen::Vector2f low = Eigen::Vector2f::Constant(1e9f), high = -low;
  for (const auto& p : v.points) {
    if (p.z() < v.top_m - kRimHeight_m) continue;
    low = low.cwiseMin(p.head<2>());
    high = high.cwiseMax(p.head<2>());
  }
  v.middle = 0.5f * (low + high);
  v.narrow_m = 0.5f * (high - low).minCoeff();
}

int DirectionOf(const Eigen::Vector2f& from_middle) {
  const double turn = std::atan2(from_middle.y(), from_middle.x()) / (2 * std::numbers::pi);
  return static_cast<int>(std::lround(turn * kDirections) + kDirections) % kDirections;
}

// Distance of the rim from the middle in each direction; 0 where it was not seen.
std::array<float, kDirections> RimRadii(const Vessel& v) {
  std::array<float, kDirections> radii{};
  for (const auto& p : v.points) {
    if (p.z() < v.top_m - kRimHeight_m) continue;
    const Eigen::Vector2f from_middle = p.head<2>() - v.middle;
    float& radius = radii[static_cast<size_t>(DirectionOf(from_middle))];
    radius = std::max(radius, from_middle.norm());
  }
  return radii;
}

bool IsHollow(const Vessel& v) {
  int below = 0, lid = 0;
  for (const auto& p : v.points) {
    if ((p.head<2>() - v.middle).norm() > kInside * v.narrow_m) continue;
    below += p.z() < v.top_m - kHollow_m;
    lid += p.z() > v.top_m - kRimHeight_m;
  }
  const double all = static_cast<double>(v.points.size());
  return below > kLeastHollow * all && lid < kMostLid * all;
}

// The wall in a direction, from its points between the fingers: x outwards, y along the rim, z up;
// x = a + b y + c z by least squares gives its normal (1, -b, -c).
std::optional<RimPinch> PinchAt(const Vessel& v, int direction, float radius,
                                const GripperConfig& gripper) {
  const double turn = 2 * std::numbers::pi * direction / kDirections;
  const Eigen::Vector2f out(static_cast<float>(std::cos(turn)), static_cast<float>(std::sin(turn)));
  const Eigen::Vector2f along(-out.y(), out.x());
  const double deepest_m = std::min(kPinch_m, gripper.finger_depth_m - gripper.clearance_m);
  const double tips_m = std::max(v.top_m - deepest_m, gripper.clearance_m);
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double low = 1e9, high = -1e9;
  int count = 0;
  for (const auto& p : v.points) {
    const Eigen::Vector2f q = p.head<2>() - v.middle;
    const double x = out.dot(q), y = along.dot(q);
    if (x < kInside * radius || std::abs(y) > gripper.finger_half_width_m || p.z() < tips_m)
      continue;
    const Eigen::Vector3d row(1, y, p.z() - tips_m);
    normal += row * row.transpose();
    right += x * row;
    low = std::min(low, x);
    high = std::max(high, x);
    ++count;
  }
  if (count < kFewestOnWall) return std::nullopt;
  normal.diagonal() += Eigen::Vector3d(0, 1e-8, 1e-8) * count;  // few points: as if it were upright
  const Eigen::Vector3d plane = normal.ldlt().solve(right);
  RimPinch pinch;
  pinch.slip_rad = std::atan(plane.tail<2>().norm());
  pinch.width_m = high - low + kWall_m;
  pinch.held_m = v.top_m - tips_m;
  if (!(pinch.slip_rad <= gripper.max_slip_rad) || pinch.held_m <= 0 ||
      pinch.width_m + 2 * gripper.clearance_m > gripper.max_opening_m) {
    return std::nullopt;
  }
  const Eigen::Vector2d at = v.middle.cast<double>() + 0.5 * (low + high) * out.cast<double>();
  const Eigen::Vector3d closing = v.axes.leftCols<2>() * out.cast<double>();
  const Eigen::Vector3d down = -v.axes.col(2);
  pinch.X_FG.linear() << closing, down.cross(closing), down;
  pinch.X_FG.translation() = v.axes * Eigen::Vector3d(at.x(), at.y(), tips_m - v.table_offset_m);
  return pinch;
}

}  // namespace

OpenRim FindOpenRim(std::span<const Eigen::Vector3f> points_F, const Plane& table_F,
                    const GripperConfig& gripper) {
  OpenRim rim;
  Vessel v = OnTable(points_F, table_F);
  if (v.points.empty()) return rim;
  FindTop(v);
  if (!IsHollow(v)) return rim;
  const auto radii = RimRadii(v);
  const auto seen = std::count_if(radii.begin(), radii.end(), [](float r) { return r > 0; });
  rim.seen = static_cast<double>(seen) / kDirections;
  rim.middle_F = v.axes * Eigen::Vector3d(v.middle.x(), v.middle.y(), v.top_m - v.table_offset_m);
  if (rim.seen < kLeastSeen) return rim;
  for (int i = 0; i < kDirections; ++i) {
    const float here = radii[static_cast<size_t>(i)];
    if (here <= 0) continue;
    if (const auto pinch = PinchAt(v, i, here, gripper)) rim.pinches.push_back(*pinch);
  }
  return rim;
}

}  // namespace beckon::pose
