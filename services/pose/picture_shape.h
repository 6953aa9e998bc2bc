// What a picture shows of a superquadric: its wireframe, its axes, points near it, the table below.
#pragma once

#include <span>
#include <vector>

#include "services/pose/picture_canvas.h"
#include "services/pose/picture_view.h"
#include "services/pose/superquadric.h"

namespace beckon::pose {

/// Which lines of a body are meant: those that its own front hides, or the others.
enum class Sight { kHidden, kVisible };

struct WireStyle {
  Colour colour;
  double width_px = 1;
  bool dashed = false;
};

/// Level rings and meridians, where they are visible or where the shape itself, or one of those
/// `in_front`, hides them.
void DrawWireframe(const Superquadric& shape, const PictureView& view, Sight sight,
                   const WireStyle& style, Canvas* canvas,
                   std::span<const Superquadric> in_front = {});

/// The frame O: x red, y green, z blue with their letters, from the centre to beyond the surface;
/// thin inside the shape and where it hides them.
void DrawAxes(const Superquadric& shape, const PictureView& view, double letter_px, Canvas* canvas);

/// Points of which `shapes` say whether they lie on the side that the view shows, coloured by their
/// distance to the nearest of them.
void DrawPoints(const std::vector<Eigen::Vector3f>& points_F, std::span<const Superquadric> shapes,
                const PictureView& view, Sight sight, Canvas* canvas);

/// The colour of a distance to a fitted surface: dark blue at 0, by purple to orange at
/// kFarDistance_m and beyond; lightness grows all the way, so that it is told apart without colour.
inline constexpr double kFarDistance_m = 0.005;
Colour DistanceColour(double distance_m);

/// A grid of kGrid_m on the table around the foot of a point.
inline constexpr double kGrid_m = 0.05;
void DrawTable(const Plane& table_F, const Eigen::Vector3d& above_F, double radius_m,
               const PictureView& view, Canvas* canvas);

/// Points of the surface and the ends of the axes: what a picture must have room for.
std::vector<Eigen::Vector3d> Extremes(const Superquadric& shape);

/// Whether a shape stands between the eye and a point.
bool Hides(const Superquadric& shape, const Eigen::Vector3d& eye_F, const Eigen::Vector3d& p_F);

}  // namespace beckon::pose
