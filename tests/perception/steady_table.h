// A table with objects on it that stand still, move or are taken away, in front of a noisy depth
// camera.
#pragma once

#include <optional>
#include <vector>

#include "services/capture/embedded_kinect.h"
#include "services/capture/embedded_stage.h"

namespace beckon::perception {

/// Built of the embedded scene's parts. Objects are numbered from 0.
class SteadyTable {
 public:
  /// `n_objects` of different categories in two rows, the nearer ones hiding parts of the others.
  SteadyTable(uint64_t seed, int n_objects);

  /// The next frame: what is there now, with noise of its own.
  RgbdImage Next();
  /// Of the last frame: per pixel, 0 = no object, k + 1 = object k.
  const std::vector<uint16_t>& labels() const { return depth_.labels; }

  void Move(int object, double dx_m, double dy_m, double dz_m = 0);
  void Remove(int object);
  void PutBack(int object);
  /// Adds a box of the given size, its lower side centred at (x, y, z) in W.
  int AddBox(const Eigen::Vector3d& size_m, const Eigen::Vector3d& at_W, const Rgb& colour);

  int n_objects() const { return static_cast<int>(objects_.size()); }
  /// The place on the table at which the camera looks.
  double aim_y_m() const { return stage_.aim_y_m; }

 private:
  struct Object {
    capture::Model model;
    Pose X_WO;
    bool there = true;
  };

  void Place(int object, double x_m, double y_m);

  capture::Random random_;
  capture::Stage stage_;
  capture::DepthNoise noise_;
  std::vector<Object> objects_;
  std::optional<capture::Rendering> rendering_;  // of what is there now
  capture::KinectDepth depth_;
};

}  // namespace beckon::perception
