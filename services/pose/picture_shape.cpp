// What a picture shows of a superquadric: its wireframe, its axes, points near it, the table below.
#include "services/pose/picture_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "services/pose/surface.h"

namespace beckon::pose {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr size_t kMostPoints = 6000;  // of a cloud; more of them hide each other
constexpr double kHiddenLightness = 0.72;
const std::array<Colour, 3> kAxisColours = {Colour(30, 30, 215), Colour(50, 140, 0),
                                            Colour(225, 90, 20)};

/// Draws a line through points in pieces, dashed by its length on the picture.
class Stroke {
 public:
  Stroke(const WireStyle& style, Canvas* canvas) : style_(style), canvas_(canvas) {}

  void Add(const std::optional<cv::Point2d>& from, const std::optional<cv::Point2d>& to) {
    constexpr double kDash_px = 5, kPeriod_px = 9;
    if (!from || !to) return;
    if (!style_.dashed || std::fmod(length_px_, kPeriod_px) < kDash_px)
      canvas_->Line(*from, *to, style_.colour, style_.width_px);
    length_px_ += std::hypot(to->x - from->x, to->y - from->y);
  }

 private:
  WireStyle style_;
  Canvas* canvas_;
  double length_px_ = 0;
};

// Of a convex body: where its surface faces away from the eye.
bool FacesAway(const Superquadric& shape, const Eigen::Vector3d& eye_F,
               const Eigen::Vector3d& p_F) {
  const Eigen::Vector3d p_O = shape.X_FO.inverse() * p_F;
  const Eigen::Vector3d eye_O = shape.X_FO.inverse() * eye_F;
  return NormalAt(shape, p_O).dot(eye_O - p_O) < 0;
}

using Wire = std::vector<Eigen::Vector3d>;

// The unit superellipse |x|^(2/e) + |y|^(2/e) = 1 on the ray at an angle.
Eigen::Vector2d Superellipse(double angle, double epsilon) {
  const double c = std::abs(std::cos(angle)), s = std::abs(std::sin(angle));
  const double larger = std::max(c, s), power = 2 / epsilon;
  const double gauge =
      larger * std::pow(std::pow(c / larger, power) + std::pow(s / larger, power), 1 / power);
  return {std::cos(angle) / gauge, std::sin(angle) / gauge};
}

// Angles 0 .. pi/2 that cut a quarter of the superellipse into pieces of about equal length: a
// square's corner is then one of them.
std::vector<double> EqualPieces(int pieces, double epsilon) {
  constexpr int kSteps = 720;
  std::vector<double> length{0};
  for (int i = 1; i <= kSteps; ++i) {
    const double step = kPi / 2 / kSteps;
    length.push_back(
        length.back() +
        (Superellipse(i * step, epsilon) - Superellipse((i - 1) * step, epsilon)).norm());
  }
  std::vector<double> angles;
  for (int k = 0; k <= pieces; ++k) {
    const auto at = std::lower_bound(length.begin(), length.end(), length.back() * k / pieces);
    angles.push_back(kPi / 2 * static_cast<double>(at - length.begin()) / kSteps);
  }
  return angles;
}

// The surface where the profile's angle is `along` (0 at the equator, pi/2 at the pole) and the
// cross-section's is `around`: lines of equal `along` are level.
Eigen::Vector3d SurfaceAt(const Superquadric& shape, double along, double around) {
  const Eigen::Vector2d profile = Superellipse(along, shape.epsilon[0]);
  const double radius = profile.x() * Superellipse(around, shape.epsilon[1]).norm();
  return SurfacePoint(shape, std::atan2(profile.y(), radius), around);
}

// Seven level rings and sixteen meridians, evenly apart on the unit shape; every second meridian
// stops at the last ring, lest they crowd the poles.
std::vector<Wire> Wires(const Superquadric& shape) {
  constexpr int kPieces = 4, kSegments = 160;
  const std::vector<double> rings = EqualPieces(kPieces, shape.epsilon[0]);
  const std::vector<double> meridians = EqualPieces(kPieces, shape.epsilon[1]);
  std::vector<Wire> wires;
  for (int i = 1 - kPieces; i < kPieces; ++i) {
    Wire& wire = wires.emplace_back();
    const double along = std::copysign(rings[static_cast<size_t>(std::abs(i))], i);
    for (int k = 0; k <= kSegments; ++k)
      wire.push_back(SurfaceAt(shape, along, 2 * kPi * k / kSegments));
  }
  for (int i = 0; i < 4 * kPieces; ++i) {
    Wire& wire = wires.emplace_back();
    const double around = kPi / 2 * (i / kPieces) + meridians[static_cast<size_t>(i % kPieces)];
    const double end = i % 2 == 0 ? kPi / 2 : rings[kPieces - 1];
    for (int k = 0; k <= kSegments / 2; ++k)
      wire.push_back(SurfaceAt(shape, end * (4.0 * k / kSegments - 1), around));
  }
  return wires;
}

Eigen::Vector3d AxisEnd(const Superquadric& shape, int axis) {
  const double beyond_m = 0.35 * shape.semi_axes.mean();
  return shape.X_FO *
         Eigen::Vector3d((shape.semi_axes[axis] + beyond_m) * Eigen::Vector3d::Unit(axis));
}

}  // namespace

bool Hides(const Superquadric& shape, const Eigen::Vector3d& eye_F, const Eigen::Vector3d& p_F) {
  // Along a line the gauge of a convex body has one minimum; a golden section finds it.
  const Eigen::Vector3d eye = shape.X_FO.inverse() * eye_F, p = shape.X_FO.inverse() * p_F;
  const auto gauge = [&](double t) { return Gauge(shape, p + t * (eye - p)); };
  const double golden = 0.5 * (std::sqrt(5.0) - 1);
  double lo = 0, hi = 1;
  for (int i = 0; i < 24; ++i) {
    const double a = hi - golden * (hi - lo), b = lo + golden * (hi - lo);
    (gauge(a) < gauge(b) ? hi : lo) = gauge(a) < gauge(b) ? b : a;
  }
  return gauge(0.5 * (lo + hi)) < 0.98;
}

void DrawWireframe(const Superquadric& shape, const PictureView& view, Sight sight,
                   const WireStyle& style, Canvas* canvas, std::span<const Superquadric> in_front) {
  const Eigen::Vector3d eye = view.eye_F();
  const auto hidden = [&](const Eigen::Vector3d& p) {
    return FacesAway(shape, eye, p) ||
           std::any_of(in_front.begin(), in_front.end(),
                       [&](const Superquadric& other) { return Hides(other, eye, p); });
  };
  for (const auto& wire : Wires(shape)) {
    Stroke stroke(style, canvas);
    for (size_t i = 1; i < wire.size(); ++i) {
      const Eigen::Vector3d middle = 0.5 * (wire[i - 1] + wire[i]);
      const Sight seen = hidden(middle) ? Sight::kHidden : Sight::kVisible;
      if (seen == sight) stroke.Add(view.At(wire[i - 1]), view.At(wire[i]));
    }
  }
}

void DrawAxes(const Superquadric& shape, const PictureView& view, double letter_px,
              Canvas* canvas) {
  constexpr int kPieces = 24;
  const double width_px = letter_px / 6;
  const auto centre = view.At(shape.X_FO.translation());
  for (int axis = 0; axis < 3; ++axis) {
    const Colour& colour = kAxisColours[static_cast<size_t>(axis)];
    const Eigen::Vector3d from = shape.X_FO.translation(), end = AxisEnd(shape, axis);
    const auto tip = view.At(end);
    if (!centre || !tip) continue;
    const auto at = [&](int piece) {
      return Eigen::Vector3d(from + (end - from) * piece / kPieces);
    };
    for (int i = 0; i < kPieces; ++i) {
      const auto a = view.At(at(i)), b = view.At(at(i + 1));
      const bool hidden = Hides(shape, view.eye_F(), 0.5 * (at(i) + at(i + 1)));
      if (a && b) canvas->Line(*a, *b, colour, hidden ? 0.5 * width_px : width_px);
    }
    const cv::Point2d along = *tip - *centre;
    const double length = std::hypot(along.x, along.y);
    const cv::Point2d outward = length > 1 ? along / length : cv::Point2d(0, -1);
    if (!Hides(shape, view.eye_F(), end))
      canvas->Arrow(*tip - outward, *tip + outward * letter_px * 0.4, colour, width_px,
                    letter_px * 0.6);
    const cv::Point2d letter = *tip + outward * letter_px * 0.95;
    canvas->TextOnAnything(std::string(1, static_cast<char>('x' + axis)),
                           letter + cv::Point2d(-0.35 * letter_px, 0.35 * letter_px), letter_px,
                           colour);
  }
  if (centre) canvas->Dot(*centre, width_px, Colour(40, 40, 40));
}

void DrawPoints(const std::vector<Eigen::Vector3f>& points_F, std::span<const Superquadric> shapes,
                const PictureView& view, Sight sight, Canvas* canvas) {
  const Eigen::Vector3d eye = view.eye_F();
  const size_t step = points_F.size() / kMostPoints + 1;
  const double radius_px = points_F.size() < 200 ? 2.5 : 1.1;
  for (size_t i = 0; i < points_F.size(); i += step) {
    if (!points_F[i].allFinite()) continue;
    const Eigen::Vector3d p = points_F[i].cast<double>();
    double nearest_m = kFarDistance_m;
    const Superquadric* owner = shapes.empty() ? nullptr : &shapes.front();
    for (const auto& shape : shapes) {
      const double distance_m = RadialDistance(shape, p);
      if (distance_m >= nearest_m) continue;
      nearest_m = distance_m;
      owner = &shape;
    }
    const bool away = owner && FacesAway(*owner, eye, p);
    const auto px = view.At(p);
    if (!px || away != (sight == Sight::kHidden)) continue;
    canvas->Dot(*px, radius_px, Lighter(DistanceColour(nearest_m), away ? kHiddenLightness : 0.25));
  }
}

Colour DistanceColour(double distance_m) {
  // The lower part of the map "plasma" of matplotlib (CC0): made for the colour-blind too.
  static const cv::Mat kTable = [] {
    cv::Mat grey(1, 256, CV_8U), table;
    for (int i = 0; i < 256; ++i) grey.at<uint8_t>(i) = static_cast<uint8_t>(i);
    cv::applyColorMap(grey, table, cv::COLORMAP_PLASMA);
    return table;
  }();
  constexpr double kLast = 205;  // beyond it is too light for paper
  const double part =
      std::isfinite(distance_m) ? std::clamp(distance_m / kFarDistance_m, 0.0, 1.0) : 1.0;
  const auto& c = kTable.at<cv::Vec3b>(cvRound(kLast * part));
  return {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])};
}

void DrawTable(const Plane& table_F, const Eigen::Vector3d& above_F, double radius_m,
               const PictureView& view, Canvas* canvas) {
  constexpr int kMostLines = 10;
  const Colour line(214, 208, 202);
  const Eigen::Vector3d up = table_F.normal;
  const Eigen::Vector3d foot = above_F - up * table_F.Distance(above_F);
  // Along what the camera of the view sees as its right, so that the grid lies still.
  Eigen::Vector3d right = view.X_VF.linear().row(0).transpose();
  right -= up * up.dot(right);
  right = right.norm() > 1e-6 ? right.normalized() : up.unitOrthogonal();
  const Eigen::Vector3d ahead = up.cross(right);
  if (!(radius_m > 0)) return;
  const int lines = std::min(kMostLines, static_cast<int>(std::ceil(radius_m / kGrid_m)));
  for (int i = -lines; i <= lines; ++i) {
    for (int k = -lines; k < lines; ++k) {
      for (const bool across : {true, false}) {
        const Eigen::Vector3d& u = across ? right : ahead;
        const Eigen::Vector3d& v = across ? ahead : right;
        const Eigen::Vector3d from = foot + kGrid_m * (i * u + k * v);
        const auto a = view.At(from), b = view.At(from + kGrid_m * v);
        if (a && b) canvas->Line(*a, *b, line, 0.7);
      }
    }
  }
}

std::vector<Eigen::Vector3d> Extremes(const Superquadric& shape) {
  std::vector<Eigen::Vector3d> points = SampleSurface(shape, 200);
  for (int axis = 0; axis < 3; ++axis) points.push_back(AxisEnd(shape, axis));
  return points;
}

}  // namespace beckon::pose
