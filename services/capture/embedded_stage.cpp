#include "services/capture/embedded_stage.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beckon::capture {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// A horizontal or upright rectangle whose texture repeats every `tile_m`.
void AddPanel(Mesh& mesh, const std::array<Eigen::Vector3d, 4>& corners, uint32_t material,
              double tile_m) {
  // v is clamped in a texture, so rows of quads repeat it.
  const Eigen::Vector3d along = corners[1] - corners[0], up = corners[3] - corners[0];
  const int rows = std::max(1, static_cast<int>(std::ceil(up.norm() / tile_m)));
  for (int r = 0; r < rows; ++r) {
    const double t0 = r * tile_m / up.norm(), t1 = std::min(1.0, (r + 1) * tile_m / up.norm());
    const Eigen::Vector3d low = corners[0] + up * t0, high = corners[0] + up * t1;
    AddQuad(mesh, {{low, low + along, high + along, high}}, material, {0, 0},
            {along.norm() / tile_m, (t1 - t0) * up.norm() / tile_m});
  }
}

Model MakeFurniture(const Stage& stage, Random& random) {
  Model room;
  const uint32_t table = room.AddMaterial(TableTexture(random), random.Chance(0.3) ? 0.15f : 0.0f);
  const uint32_t edge = room.AddMaterial(PlainTexture(CrockeryColour(random)), 0.0f);
  const uint32_t floor = room.AddMaterial(TableTexture(random), 0.0f);
  Rgb paint = CrockeryColour(random);  // walls are paler than crockery
  for (uint8_t& channel : paint) channel = static_cast<uint8_t>(150 + channel * 2 / 5);
  const uint32_t wall = room.AddMaterial(PlainTexture(paint), 0.0f);
  const double w = stage.table_half_width_m, n = stage.table_near_m, f = stage.table_far_m;
  constexpr double kThickness_m = 0.03, kTableHeight_m = 0.73;
  AddPanel(room.mesh, {{{-w, n, 0}, {w, n, 0}, {w, f, 0}, {-w, f, 0}}}, table, 0.5);
  const double b = -kThickness_m;
  AddQuad(room.mesh, {{{-w, n, b}, {w, n, b}, {w, n, 0}, {-w, n, 0}}}, edge);
  AddQuad(room.mesh, {{{w, n, b}, {w, f, b}, {w, f, 0}, {w, n, 0}}}, edge);
  AddQuad(room.mesh, {{{-w, n, b}, {-w, f, b}, {-w, f, 0}, {-w, n, 0}}}, edge);
  AddQuad(room.mesh, {{{-w, f, b}, {w, f, b}, {w, f, 0}, {-w, f, 0}}}, edge);
  const double ground = -kTableHeight_m, back = f + random.Uniform(0.05, 2.0), top = 2.0;
  AddPanel(room.mesh, {{{-4, -2, ground}, {4, -2, ground}, {4, back, ground}, {-4, back, ground}}},
           floor, 0.8);
  AddQuad(room.mesh, {{{-4, back, ground}, {4, back, ground}, {4, back, top}, {-4, back, top}}},
          wall);
  return room;
}

double Cross(const Eigen::Vector2d& o, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return (a - o).x() * (b - o).y() - (a - o).y() * (b - o).x();
}

/// The largest separation along the normals of a's edges.
double GapAlongNormals(const std::vector<Eigen::Vector2d>& a,
                       const std::vector<Eigen::Vector2d>& b) {
  double best = -1e9;
  for (size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector2d edge = a[(i + 1) % a.size()] - a[i];
    if (edge.norm() < 1e-9) continue;
    const Eigen::Vector2d normal = Eigen::Vector2d(edge.y(), -edge.x()).normalized();
    double nearest = 1e9;
    for (const auto& p : b) nearest = std::min(nearest, normal.dot(p - a[i]));
    best = std::max(best, nearest);
  }
  return best;
}

}  // namespace

Stage MakeStage(Random& random, const CameraRange& range) {
  Stage stage;
  const double tilt = random.Uniform(range.tilt_min_deg, range.tilt_max_deg) * kDegree;
  const double distance = random.Uniform(range.range_min_m, range.range_max_m);
  const double roll = random.Uniform(-1.5, 1.5) * kDegree;
  // The table's normal as the camera sees it: up (-y), towards the camera (-z) as it looks down.
  const Eigen::Vector3d up(std::sin(roll) * std::cos(tilt), -std::cos(roll) * std::cos(tilt),
                           -std::sin(tilt));
  stage.table_C = {up, distance * std::sin(tilt)};
  stage.X_WC = WorldFromTable(stage.table_C);
  stage.aim_y_m = distance * std::cos(tilt);
  stage.table_half_width_m = random.Uniform(0.45, 1.0);
  stage.table_near_m = stage.aim_y_m - random.Uniform(0.4, 0.8);
  stage.table_far_m = stage.aim_y_m + random.Uniform(0.35, 0.9);
  stage.lighting.lamp_W = {random.Uniform(-1.2, 1.2), stage.aim_y_m + random.Uniform(-1.0, 0.8),
                           random.Uniform(1.3, 2.4)};
  stage.lighting.ambient = static_cast<float>(random.Uniform(0.5, 0.75));
  stage.lighting.lamp = static_cast<float>(random.Uniform(0.3, 0.65));
  const auto warmth = static_cast<float>(random.Uniform(-0.08, 0.08));
  stage.lighting.tint = {1 + warmth, 1, 1 - warmth};
  stage.furniture = MakeFurniture(stage, random);
  return stage;
}

std::vector<Eigen::Vector2d> Footprint(const Model& model, const Pose& X_WO) {
  std::vector<Eigen::Vector2d> points;
  for (const auto& p : model.mesh.positions) {
    points.push_back((X_WO * p.cast<double>()).head<2>());
  }
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  // Andrew's monotone chain.
  std::vector<Eigen::Vector2d> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const size_t start = hull.size();
    for (const auto& p : points) {
      while (hull.size() >= start + 2 && Cross(hull[hull.size() - 2], hull.back(), p) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

double Gap(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b) {
  return std::max(GapAlongNormals(a, b), GapAlongNormals(b, a));
}

std::optional<Window> ImageWindow(const Stage& stage, const Model& model, const Pose& X_WO,
                                  int margin_px) {
  constexpr int kWidth = 640, kHeight = 480;
  const Pose X_CO = stage.X_WC.inverse() * X_WO;
  Eigen::AlignedBox2d box;
  for (const auto& p : model.mesh.positions) {
    const Eigen::Vector3d q = X_CO * p.cast<double>();
    if (q.z() < 0.1) return std::nullopt;
    box.extend(stage.intrinsics.Project(q));
  }
  const int u0 = std::max(0, static_cast<int>(std::floor(box.min().x())) - margin_px);
  const int v0 = std::max(0, static_cast<int>(std::floor(box.min().y())) - margin_px);
  const int u1 = std::min(kWidth - 1, static_cast<int>(std::ceil(box.max().x())) + margin_px);
  const int v1 = std::min(kHeight - 1, static_cast<int>(std::ceil(box.max().y())) + margin_px);
  if (u1 < u0 || v1 < v0) return std::nullopt;
  return Window{u0, v0, u1 - u0 + 1, v1 - v0 + 1};
}

}  // namespace beckon::capture
