#include "tests/perception/box_world.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace beckon::perception {
namespace {

/// Distance along the ray to the box in units of `direction`, or infinity (slab method).
double Hit(const WorldBox& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  double enter = 0, leave = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    double a = (box.low[i] - origin[i]) / direction[i];
    double b = (box.high[i] - origin[i]) / direction[i];
    if (a > b) std::swap(a, b);
    enter = std::max(enter, a);
    leave = std::min(leave, b);
  }
  return enter <= leave && enter > 0 ? enter : std::numeric_limits<double>::infinity();
}

/// The same for a cup: its outer and inner wall and its bottom.
double Hit(const WorldCup& cup, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  auto take = [&](double t, bool good) {
    if (good && t > 0 && t < nearest) nearest = t;
  };
  const Eigen::Vector2d from = origin.head<2>() - cup.centre, along = direction.head<2>();
  for (double radius_m : {cup.radius_m, cup.radius_m - cup.wall_m}) {
    const double a = along.squaredNorm(), b = from.dot(along);
    const double root = b * b - a * (from.squaredNorm() - radius_m * radius_m);
    if (root < 0) continue;
    for (double side : {-1.0, 1.0}) {
      const double t = (-b + side * std::sqrt(root)) / a;
      const double z = origin.z() + t * direction.z();
      take(t, z >= 0 && z <= cup.height_m);
    }
  }
  const double bottom = (cup.wall_m - origin.z()) / direction.z();
  take(bottom, (from + bottom * along).norm() < cup.radius_m);
  return nearest;
}

}  // namespace

Pose BoxWorld::X_WC() const {
  const double pitch = pitch_deg * std::numbers::pi / 180;
  Pose pose = Pose::Identity();
  pose.linear().col(0) = Eigen::Vector3d::UnitX();
  pose.linear().col(2) = Eigen::Vector3d(0, std::cos(pitch), -std::sin(pitch));
  pose.linear().col(1) = pose.linear().col(2).cross(pose.linear().col(0));
  pose.translation() = Eigen::Vector3d(0, 0, camera_height_m);
  return pose;
}

RgbdImage BoxWorld::Render(std::vector<int>* box_of_pixel, unsigned seed) const {
  RgbdImage image;
  image.width = width;
  image.height = height;
  image.intrinsics = {525.0 * width / 640, 525.0 * width / 640, (width - 1) / 2.0,
                      (height - 1) / 2.0};
  image.depth_m.assign(static_cast<size_t>(width) * height, 0);
  image.colour.assign(image.depth_m.size(), Rgb{0, 0, 0});
  if (box_of_pixel != nullptr) box_of_pixel->assign(image.depth_m.size(), 0);
  const Pose camera = X_WC();
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const Eigen::Vector3d ray = camera.linear() * image.intrinsics.Unproject(u, v, 1);
      double nearest_m = std::numeric_limits<double>::infinity();
      size_t which = 0;
      for (size_t b = 0; b < boxes.size(); ++b) {
        const double depth_m = Hit(boxes[b], camera.translation(), ray);
        if (depth_m < nearest_m) nearest_m = depth_m, which = b;
      }
      for (size_t c = 0; c < cups.size(); ++c) {
        const double depth_m = Hit(cups[c], camera.translation(), ray);
        if (depth_m < nearest_m) nearest_m = depth_m, which = boxes.size() + c;
      }
      if (!std::isfinite(nearest_m)) continue;
      const size_t i = image.Index(u, v);
      image.depth_m[i] =
          static_cast<float>(nearest_m + noise_m * nearest_m * nearest_m * normal(engine));
      image.colour[i] = which < boxes.size() ? boxes[which].colour : Rgb{90, 200, 60};
      if (box_of_pixel != nullptr) (*box_of_pixel)[i] = static_cast<int>(which) + 1;
    }
  }
  return image;
}

WorldBox Table() { return {{-0.6, 0.3, -0.03}, {0.6, 1.3, 0}}; }

WorldBox Standing(double x, double y, double size_x, double size_y, double size_z) {
  return {
      {x - size_x / 2, y - size_y / 2, 0}, {x + size_x / 2, y + size_y / 2, size_z}, {60, 90, 200}};
}

WorldBox At(double x, double y, double z, double size_x, double size_y, double size_z) {
  WorldBox box = Standing(x, y, size_x, size_y, size_z);
  box.low.z() += z;
  box.high.z() += z;
  return box;
}

BoxWorld ThreeBoxes() {
  BoxWorld world;
  world.boxes = {Table(), Standing(-0.2, 0.6, 0.1, 0.08, 0.12),
                 Standing(0.15, 0.7, 0.08, 0.08, 0.2), Standing(0.02, 0.95, 0.15, 0.1, 0.06)};
  return world;
}

}  // namespace beckon::perception
