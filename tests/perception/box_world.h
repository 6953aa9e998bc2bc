// A world of boxes seen by a camera, for tests that need to know what is there.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "services/base/rgbd.h"

namespace beckon::perception {

/// Axis-aligned in W (z up, y away from the camera).
struct WorldBox {
  Eigen::Vector3d low, high;
  Rgb colour{200, 180, 160};
};

/// An open-topped tube with a bottom, standing upright on z = 0 of W: a cup.
struct WorldCup {
  Eigen::Vector2d centre;
  double radius_m = 0.04, height_m = 0.1, wall_m = 0.003;
};

struct BoxWorld {
  std::vector<WorldBox> boxes;
  std::vector<WorldCup> cups;
  double camera_height_m = 0.6;
  double pitch_deg = 38;  // downwards
  int width = 320, height = 240;
  double noise_m = 0;  // standard deviation at 1 m, growing with the square of the depth

  /// The camera in W.
  Pose X_WC() const;
  /// What the camera sees; `box_of_pixel`, where not null, tells which box (index + 1, 0 = none);
  /// cups count on from the boxes.
  RgbdImage Render(std::vector<int>* box_of_pixel = nullptr, unsigned seed = 1) const;
};

/// A table top 1.2 m wide, 0.3 .. 1.3 m away, at z = 0.
WorldBox Table();
/// A box of the given size standing at (x, y) on the table.
WorldBox Standing(double x, double y, double size_x, double size_y, double size_z);
/// The same with its lower face at z.
WorldBox At(double x, double y, double z, double size_x, double size_y, double size_z);
/// A camera's noise at 1 m (BoxWorld::noise_m), about a Kinect's.
inline constexpr double kKinectNoise_m = 0.0015;
/// The table with three boxes on it, well apart.
BoxWorld ThreeBoxes();

}  // namespace beckon::perception
