// Clouds of known superquadrics for tests: whole surfaces, and what one camera sees of them.
#include "tests/pose/views.h"

#include <algorithm>

namespace beckon::pose {

Superquadric MakeShape(const Eigen::Vector3d& semi_axes, double e1, double e2,
                       const Eigen::Vector3d& position, const Eigen::Vector3d& rotation_vector) {
  Superquadric shape;
  shape.semi_axes = semi_axes;
  shape.epsilon = {e1, e2};
  shape.X_FO.translation() = position;
  const double angle = rotation_vector.norm();
  if (angle > 0)
    shape.X_FO.linear() = Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix();
  return shape;
}

std::vector<Eigen::Vector3f> WholeSurface(const Superquadric& shape, int count, double sigma_m,
                                          unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> noise(0, 1);
  std::vector<Eigen::Vector3f> points;
  for (const auto& p : SampleSurface(shape, count)) {
    points.push_back((p + sigma_m * noise(engine) * p.normalized()).cast<float>());
  }
  return points;
}

namespace {

/// 0.8 m from W's origin, 40 degrees above the table.
Pose CameraAtTable() {
  const double pitch = 40 * M_PI / 180, distance = 0.8;
  const Eigen::Vector3d forward(0, std::cos(pitch), -std::sin(pitch)), right(1, 0, 0);
  Pose X_WC = Pose::Identity();
  X_WC.linear() << right, forward.cross(right), forward;
  X_WC.translation() = -distance * forward;
  return X_WC;
}

/// The depth at which a ray (z = 1) from the origin enters the shape, to 1e-6 m; 0 where it does
/// not.
double EntryDepth(const Superquadric& shape_C, const Eigen::Vector3d& ray) {
  const Pose X_OC = shape_C.X_FO.inverse();
  const double middle_m = shape_C.X_FO.translation().dot(ray) / ray.squaredNorm();
  const double reach_m = shape_C.semi_axes.norm();
  if ((middle_m * ray - shape_C.X_FO.translation()).norm() > reach_m) return 0;
  const auto inside = [&](double depth_m) { return Gauge(shape_C, X_OC * (depth_m * ray)) < 1; };
  double outside_m = middle_m - reach_m;
  for (double step_m = 0.002; outside_m < middle_m + reach_m; outside_m += step_m) {
    if (!inside(outside_m + step_m)) continue;
    while (step_m > 1e-6) {
      step_m /= 2;
      if (!inside(outside_m + step_m)) outside_m += step_m;
    }
    return outside_m;
  }
  return 0;
}

}  // namespace

TableScene SceneOnTable(const std::vector<Superquadric>& shapes_W, double sigma_m, unsigned seed) {
  const Pose X_WC = CameraAtTable(), X_CW = X_WC.inverse();
  TableScene scene;
  scene.table_C = {X_CW.linear().col(2), X_WC.translation().z()};
  for (Superquadric shape : shapes_W) {
    shape.X_FO = X_CW * shape.X_FO;
    scene.shapes_C.push_back(shape);
  }
  scene.image.width = 320;
  scene.image.height = 240;
  scene.image.intrinsics = {262.5, 262.5, 159.5, 119.5};
  std::mt19937 engine(seed);
  std::normal_distribution<double> noise(0, sigma_m);
  for (int v = 0; v < scene.image.height; ++v) {
    for (int u = 0; u < scene.image.width; ++u) {
      const Eigen::Vector3d ray = scene.image.intrinsics.Unproject(u, v, 1);
      double nearest_m = -scene.table_C.offset_m / scene.table_C.normal.dot(ray);
      size_t label = 0;
      for (size_t k = 0; k < scene.shapes_C.size(); ++k) {
        const double depth_m = EntryDepth(scene.shapes_C[k], ray);
        if (depth_m > 0 && depth_m < nearest_m) nearest_m = depth_m, label = k + 1;
      }
      scene.image.depth_m.push_back(
          static_cast<float>(nearest_m + (sigma_m > 0 ? noise(engine) : 0)));
      scene.labels.push_back(static_cast<uint16_t>(label));
    }
  }
  return scene;
}

TableView ViewOnTable(const Superquadric& shape_W, int count, double sigma_m, unsigned seed) {
  const Pose X_WC = CameraAtTable(), X_CW = X_WC.inverse();
  TableView view;
  view.shape_C = shape_W;
  view.shape_C.X_FO = X_CW * shape_W.X_FO;
  view.table_C.normal = X_CW.linear().col(2);
  view.table_C.offset_m = X_WC.translation().z();
  std::mt19937 engine(seed);
  std::normal_distribution<double> noise(0, 1);
  for (const auto& p : SampleSurface(view.shape_C, 2 * count)) {
    const Eigen::Vector3d normal =
        view.shape_C.X_FO.linear() * NormalAt(view.shape_C, view.shape_C.X_FO.inverse() * p);
    if (normal.dot(p.normalized()) > -0.14)
      continue;  // turned away, or by less than 8 degrees towards
    view.points_C.push_back((p * (1 + sigma_m * noise(engine) / p.z())).cast<float>());
  }
  return view;
}

TableView PixelViewOnTable(const Superquadric& shape_W, double sigma_m, unsigned seed) {
  const Pose X_WC = CameraAtTable(), X_CW = X_WC.inverse();
  TableView view;
  view.shape_C = shape_W;
  view.shape_C.X_FO = X_CW * shape_W.X_FO;
  view.table_C = {X_CW.linear().col(2), X_WC.translation().z()};
  const Intrinsics intrinsics;
  std::mt19937 engine(seed);
  std::normal_distribution<double> noise(0, 1);
  const Eigen::Vector3d& centre_C = view.shape_C.X_FO.translation();
  const Eigen::Vector2d middle = intrinsics.Project(centre_C);
  const double reach_m = shape_W.semi_axes.norm();
  const int reach = static_cast<int>(1.2 * intrinsics.fx * reach_m / (centre_C.z() - reach_m));
  const int u0 = static_cast<int>(middle.x()), v0 = static_cast<int>(middle.y());
  for (int v = std::max(v0 - reach, 0); v < std::min(v0 + reach, 480); ++v) {
    for (int u = std::max(u0 - reach, 0); u < std::min(u0 + reach, 640); ++u) {
      const Eigen::Vector3d ray = intrinsics.Unproject(u, v, 1);
      const double depth_m = EntryDepth(view.shape_C, ray);
      if (depth_m == 0 || view.table_C.Distance(depth_m * ray) < 0) continue;
      view.points_C.push_back(((depth_m + sigma_m * noise(engine)) * ray).cast<float>());
    }
  }
  return view;
}

TableView BowlOnTable(double radius_m, double height_m, double sigma_m, unsigned seed) {
  const Pose X_WC = CameraAtTable(), X_CW = X_WC.inverse();
  TableView view;
  view.shape_C = MakeShape({radius_m, radius_m, 0.5 * height_m}, 0.1, 0.1, {0, 0, 0.5 * height_m});
  view.shape_C.X_FO = X_CW * view.shape_C.X_FO;
  view.table_C = {X_CW.linear().col(2), X_WC.translation().z()};
  const Intrinsics intrinsics;
  std::mt19937 engine(seed);
  std::normal_distribution<double> noise(0, 1);
  const Eigen::Vector3d centre_C = X_CW * Eigen::Vector3d(0, 0, radius_m);
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) {
      const Eigen::Vector3d ray = intrinsics.Unproject(u, v, 1);
      const double middle_m = ray.dot(centre_C) / ray.squaredNorm();
      const double half2 =
          (radius_m * radius_m - (middle_m * ray - centre_C).squaredNorm()) / ray.squaredNorm();
      if (half2 < 0) continue;
      // The outside of the near wall, or over the rim the inside of the far one.
      for (const double depth_m : {middle_m - std::sqrt(half2), middle_m + std::sqrt(half2)}) {
        if (view.table_C.Distance(depth_m * ray) > height_m) continue;
        view.points_C.push_back(((depth_m + sigma_m * noise(engine)) * ray).cast<float>());
        break;
      }
    }
  }
  return view;
}

CutLine CutAway(double angle_rad, double share, std::vector<Eigen::Vector3f>& points_C) {
  const Eigen::Vector2d normal(std::cos(angle_rad), std::sin(angle_rad));
  const auto along = [&](const Eigen::Vector3f& p) {
    return normal.dot(p.head<2>().cast<double>()) / static_cast<double>(p.z());
  };
  std::vector<double> sorted;
  for (const auto& p : points_C) sorted.push_back(along(p));
  std::sort(sorted.begin(), sorted.end());
  const double offset =
      sorted[static_cast<size_t>((1 - share) * static_cast<double>(sorted.size() - 1))];
  std::erase_if(points_C, [&](const auto& p) { return along(p) > offset; });
  return {normal, offset};
}

}  // namespace beckon::pose
