// Clouds of known superquadrics for tests: whole surfaces, and what one camera sees of them.
#include "tests/pose/views.h"

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

TableView ViewOnTable(const Superquadric& shape_W, int count, double sigma_m, unsigned seed) {
  const double pitch = 40 * M_PI / 180, distance = 0.8;
  const Eigen::Vector3d forward(0, std::cos(pitch), -std::sin(pitch)), right(1, 0, 0);
  Pose X_WC = Pose::Identity();
  X_WC.linear() << right, forward.cross(right), forward;
  X_WC.translation() = -distance * forward;
  const Pose X_CW = X_WC.inverse();

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

}  // namespace beckon::pose
