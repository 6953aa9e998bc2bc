// Voxel grid, normals and neighbours of one object in the frame of the table.
#include "services/perception/cue_view.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/perception/cue_up.h"

namespace beckon::perception {
namespace {

constexpr size_t kMaxPixels = 8000;  // more are thinned evenly before the voxel grid
constexpr float kAssumedPitch_rad = 38.0F / 180.0F * std::numbers::pi_v<float>;

bool Inside(const ObjectView& view, uint32_t pixel) { return pixel < view.image.depth_m.size(); }

void FindMask(const ObjectView& view, CueView& out) {
  const int width = view.image.width;
  int u0 = width, v0 = view.image.height, u1 = -1, v1 = -1;
  for (const uint32_t pixel : view.pixels) {
    if (!Inside(view, pixel)) continue;
    const int u = static_cast<int>(pixel) % width;
    const int v = static_cast<int>(pixel) / width;
    u0 = std::min(u0, u), u1 = std::max(u1, u);
    v0 = std::min(v0, v), v1 = std::max(v1, v);
  }
  out.box_u = u0, out.box_v = v0;
  out.box_width = u1 - u0 + 1, out.box_height = v1 - v0 + 1;
  out.mask.assign(static_cast<size_t>(out.box_width) * out.box_height, 0);
  for (const uint32_t pixel : view.pixels) {
    if (!Inside(view, pixel)) continue;
    const int u = static_cast<int>(pixel) % width - u0;
    const int v = static_cast<int>(pixel) / width - v0;
    out.mask[static_cast<size_t>(v) * out.box_width + u] = 255;
  }
}

std::vector<Eigen::Vector3f> Unproject(const ObjectView& view) {
  std::vector<uint32_t> pixels;
  pixels.reserve(view.pixels.size());
  for (const uint32_t pixel : view.pixels) {
    if (Inside(view, pixel) && view.image.depth_m[pixel] > 0) pixels.push_back(pixel);
  }
  std::sort(pixels.begin(), pixels.end());
  const size_t stride = pixels.size() / kMaxPixels + 1;
  std::vector<Eigen::Vector3f> points;
  points.reserve(pixels.size() / stride + 1);
  for (size_t i = 0; i < pixels.size(); i += stride) {
    const int u = static_cast<int>(pixels[i]) % view.image.width;
    const int v = static_cast<int>(pixels[i]) / view.image.width;
    points.push_back(view.image.Point(u, v).cast<float>());
  }
  return points;
}

/// Rows of the result: right, away and up, in C.
Eigen::Matrix3f TableAxes(const ObjectView& view) {
  Eigen::Vector3f up(0, -std::cos(kAssumedPitch_rad), -std::sin(kAssumedPitch_rad));
  const auto& table_C = view.table_C;
  if (table_C && table_C->normal.allFinite() && table_C->normal.norm() > 0.5) {
    up = table_C->normal.normalized().cast<float>();
  } else if (const auto estimate = EstimateUp(view)) {
    up = *estimate;
  }
  Eigen::Vector3f away = Eigen::Vector3f::UnitZ() - up * up.z();
  if (away.norm() < 0.1F) away = -Eigen::Vector3f::UnitY() + up * up.y();  // looking straight down
  away.normalize();
  Eigen::Matrix3f R_TC;
  R_TC << away.cross(up).transpose(), away.transpose(), up.transpose();
  return R_TC;
}

/// Means of the points in each voxel, ordered by voxel.
Eigen::Matrix3Xf VoxelGrid(const std::vector<Eigen::Vector3f>& points, float voxel_m) {
  std::vector<std::pair<uint64_t, uint32_t>> keys(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float cell = std::clamp(points[i][axis] / voxel_m, -1e6F, 1e6F);
      key = key << 21 | static_cast<uint64_t>(static_cast<int64_t>(std::floor(cell)) + (1 << 20));
    }
    keys[i] = {key, static_cast<uint32_t>(i)};
  }
  std::sort(keys.begin(), keys.end());
  Eigen::Matrix3Xf means(3, static_cast<int>(keys.size()));
  int count = 0;
  for (size_t i = 0; i < keys.size();) {
    size_t end = i;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (; end < keys.size() && keys[end].first == keys[i].first; ++end) {
      sum += points[keys[end].second];
    }
    means.col(count++) = sum / static_cast<float>(end - i);
    i = end;
  }
  return means.leftCols(count);
}

void FindNeighbours(CueView& view) {
  const float limit = CueView::kNeighbourRadius_m * CueView::kNeighbourRadius_m;
  const int n = view.size();
  view.first.assign(1, 0);
  view.neighbours.reserve(static_cast<size_t>(n) * 100);
  view.squared_distances_m2.reserve(static_cast<size_t>(n) * 100);
  Eigen::ArrayXf squared(n);
  for (int i = 0; i < n; ++i) {
    squared = (view.points_T.row(0).array() - view.points_T(0, i)).square() +
              (view.points_T.row(1).array() - view.points_T(1, i)).square() +
              (view.points_T.row(2).array() - view.points_T(2, i)).square();
    for (int j = 0; j < n; ++j) {
      if (squared[j] > limit || j == i) continue;
      view.neighbours.push_back(static_cast<uint32_t>(j));
      view.squared_distances_m2.push_back(squared[j]);
    }
    view.first.push_back(static_cast<uint32_t>(view.neighbours.size()));
  }
}

void EstimateNormals(CueView& view) {
  const Eigen::Vector3f camera_T = -view.R_TC * view.origin_C;
  const float limit = std::max(CueView::kNormalRadius_m, 2.1F * view.voxel_m);
  view.normals_T.resize(3, view.size());
  for (int i = 0; i < view.size(); ++i) {
    const Eigen::Vector3f centre = view.points_T.col(i);
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
    int count = 1;
    for (uint32_t k = view.first[i]; k < view.first[i + 1]; ++k) {
      if (view.squared_distances_m2[k] > limit * limit) continue;
      const Eigen::Vector3f d = view.points_T.col(view.neighbours[k]) - centre;
      sum += d;
      squares += d * d.transpose();
      ++count;
    }
    const Eigen::Vector3f to_camera = (camera_T - centre).normalized();
    Eigen::Vector3f normal = to_camera;
    if (count >= 4) {
      squares -= sum * sum.transpose() / static_cast<float>(count);
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
      solver.computeDirect(squares * 1e4F);  // m^2 to cm^2: computeDirect likes ordinary numbers
      normal = solver.eigenvectors().col(0);
      if (!normal.allFinite() || normal.norm() < 0.5F) normal = to_camera;
      if (normal.dot(to_camera) < 0) normal = -normal;
    }
    view.normals_T.col(i) = normal;
  }
}

}  // namespace

int CountPoints(const ObjectView& view) {
  int count = 0;
  for (const uint32_t pixel : view.pixels) {
    if (Inside(view, pixel) && view.image.depth_m[pixel] > 0) ++count;
  }
  return count;
}

CueView MakeCueView(const ObjectView& view) {
  CueView out{.object = view};
  FindMask(view, out);
  out.R_TC = TableAxes(view);
  std::vector<Eigen::Vector3f> points = Unproject(view);
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (Eigen::Vector3f& p : points) {
    p = out.R_TC * p;
    mean += p;
  }
  mean /= static_cast<float>(points.size());

  std::vector<float> heights;
  for (const Eigen::Vector3f& p : points) heights.push_back(p.z());
  const auto low = heights.begin() + static_cast<int64_t>(heights.size() / 100);
  std::nth_element(heights.begin(), low, heights.end());
  const Eigen::Vector3f origin(mean.x(), mean.y(), *low);
  for (Eigen::Vector3f& p : points) p -= origin;
  out.origin_C = out.R_TC.transpose() * origin;

  out.points_T = VoxelGrid(points, out.voxel_m);
  while (out.size() > CueView::kMaxPoints) {
    out.voxel_m *= 1.02F * std::sqrt(static_cast<float>(out.size()) / CueView::kMaxPoints);
    out.points_T = VoxelGrid(points, out.voxel_m);
  }
  FindNeighbours(out);
  EstimateNormals(out);
  return out;
}

}  // namespace beckon::perception
