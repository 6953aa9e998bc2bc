// What stands around the objects: camera, table, floor and wall, lamp; and where objects go on the
// table.
#pragma once

#include <optional>
#include <vector>

#include "services/capture/embedded_raycaster.h"

namespace beckon::capture {

/// Camera, furniture and light of one scene.
struct Stage {
  Intrinsics intrinsics;
  Pose X_WC = Pose::Identity();
  Plane table_C;       // normal pointing to the camera
  double aim_y_m = 0;  // where the camera's axis meets the table: (0, aim_y_m, 0) in W
  double table_half_width_m = 0;
  double table_near_m = 0;  // y of the table's edges in W
  double table_far_m = 0;
  Lighting lighting;
  Model furniture;  // in W, label 0
};

/// How the camera may stand.
struct CameraRange {
  double tilt_min_deg = 34;  // below the horizontal
  double tilt_max_deg = 42;
  double range_min_m = 0.7;  // along its axis to the table
  double range_max_m = 1.1;
};

Stage MakeStage(Random& random, const CameraRange& range = {});

/// An object's outline on the table: the convex hull of its vertices' x and y, counter-clockwise.
std::vector<Eigen::Vector2d> Footprint(const Model& model, const Pose& X_WO);

/// A lower bound of the distance between convex polygons; negative where they overlap.
double Gap(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b);

/// The smallest window that holds the object's image, `margin_px` wider, cut to 640x480; none where
/// nothing of it is in view.
std::optional<Window> ImageWindow(const Stage& stage, const Model& model, const Pose& X_WO,
                                  int margin_px);

}  // namespace beckon::capture
