// Clouds of known superquadrics for tests: whole surfaces, and what one camera sees of them.
#pragma once

#include <random>
#include <vector>

#include "services/base/rgbd.h"
#include "services/pose/solid.h"
#include "services/pose/surface.h"

namespace beckon::pose {

Superquadric MakeShape(const Eigen::Vector3d& semi_axes, double e1, double e2,
                       const Eigen::Vector3d& position = Eigen::Vector3d::Zero(),
                       const Eigen::Vector3d& rotation_vector = Eigen::Vector3d::Zero());

/// The whole surface, with noise of `sigma_m` along the rays from the origin, as a camera has it.
std::vector<Eigen::Vector3f> WholeSurface(const Superquadric& shape, int count, double sigma_m = 0,
                                          unsigned seed = 1);

/// A shape on a table in front of a camera at the origin of C, 0.8 m away and 40 degrees above it.
struct TableView {
  Superquadric shape_C;
  Plane table_C;
  std::vector<Eigen::Vector3f> points_C;  // of the side that the camera sees
};
/// `shape_W`: standing on z = 0 with its centre above the origin; its pose is given in W.
TableView ViewOnTable(const Superquadric& shape_W, int count, double sigma_m = 0,
                      unsigned seed = 1);

/// What a camera of 640 x 480 pixels sees from there: a point a pixel, with noise along the rays.
TableView PixelViewOnTable(const Superquadric& shape_W, double sigma_m = 0, unsigned seed = 1);

/// The same of an open bowl: a sphere of that radius on the table, hollow, without what is above
/// `height_m`. Its shape_C is the box around it.
TableView BowlOnTable(double radius_m, double height_m, double sigma_m = 0, unsigned seed = 1);

/// A side of a view that is cut away: of the image plane, where normal.(x/z, y/z) > offset.
struct CutLine {
  Eigen::Vector2d normal;  // unit
  double offset;
};
/// The line of that direction that cuts away `share` of the points, which go.
CutLine CutAway(double angle_rad, double share, std::vector<Eigen::Vector3f>& points_C);

/// What that camera sees of several shapes on its table: an image with a label for each.
struct TableScene {
  RgbdImage image;
  std::vector<uint16_t> labels;  // row-major; k = the k-th of the shapes, 0 = table
  std::vector<Superquadric> shapes_C;
  Plane table_C;
};
TableScene SceneOnTable(const std::vector<Superquadric>& shapes_W, double sigma_m = 0,
                        unsigned seed = 1);

}  // namespace beckon::pose
