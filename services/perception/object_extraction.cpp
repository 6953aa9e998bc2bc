// Gathers each object's pixels, then measures them.
#include "services/perception/object_extraction.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beckon::perception {
namespace {

constexpr double kFinestSample_m = 0.002;

Eigen::Vector3d PointAt(const RgbdImage& image, uint32_t pixel) {
  return image.Point(static_cast<int>(pixel) % image.width, static_cast<int>(pixel) / image.width);
}

void Measure(const RgbdImage& image, const Pose& X_WC, ExtractedObject& object) {
  Eigen::Vector3d sum_C = Eigen::Vector3d::Zero();
  Eigen::Vector3d low_W = Eigen::Vector3d::Constant(std::numeric_limits<double>::max());
  Eigen::Vector3d high_W = -low_W;
  for (uint32_t pixel : object.pixels) {
    const Eigen::Vector3d p_C = PointAt(image, pixel);
    const Eigen::Vector3d p_W = X_WC * p_C;
    sum_C += p_C;
    low_W = low_W.cwiseMin(p_W);
    high_W = high_W.cwiseMax(p_W);
  }
  object.centroid_C = sum_C / static_cast<double>(object.pixels.size());
  object.centroid_W = X_WC * object.centroid_C;
  object.extent_W = high_W - low_W;
}

/// The pixels of labels 1 .. n, ascending.
std::vector<std::vector<uint32_t>> PixelsOf(std::span<const uint16_t> labels, int n) {
  std::vector<std::vector<uint32_t>> pixels(n);
  for (uint32_t pixel = 0; pixel < labels.size(); ++pixel) {
    if (const int k = labels[pixel]; k > 0) pixels[k - 1].push_back(pixel);
  }
  return pixels;
}

/// Means of the points in voxels of `edge_m`, ordered by voxel.
std::vector<Eigen::Vector3f> VoxelMeans(std::span<const Eigen::Vector3d> points_C, double edge_m) {
  std::vector<std::pair<std::array<int, 3>, uint32_t>> keyed;
  keyed.reserve(points_C.size());
  for (uint32_t i = 0; i < points_C.size(); ++i) {
    const Eigen::Vector3i cell = (points_C[i] / edge_m).array().floor().cast<int>();
    keyed.push_back({{cell.z(), cell.y(), cell.x()}, i});
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<Eigen::Vector3f> means;
  for (size_t first = 0; first < keyed.size();) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    size_t last = first;
    for (; last < keyed.size() && keyed[last].first == keyed[first].first; ++last) {
      sum += points_C[keyed[last].second];
    }
    means.push_back((sum / static_cast<double>(last - first)).cast<float>());
    first = last;
  }
  return means;
}

}  // namespace

std::vector<ExtractedObject> ExtractObjects(const RgbdImage& image,
                                            const Segmentation& segmentation, const Pose& X_WC,
                                            std::span<const uint16_t> silhouettes) {
  if (!segmentation.table_C) return {};
  const int n = segmentation.n_objects;
  auto pixels = PixelsOf(segmentation.labels, n);
  auto outlined = PixelsOf(silhouettes, n);
  std::vector<ExtractedObject> objects(n);
  for (int k = 0; k < n; ++k) {
    objects[k].pixels = std::move(pixels[k]);
    objects[k].silhouette = std::move(outlined[k]);
    Measure(image, X_WC, objects[k]);
  }
  return objects;
}

std::vector<Eigen::Vector3f> SampleSurface(const RgbdImage& image, std::span<const uint32_t> pixels,
                                           int most) {
  if (most <= 0) return {};
  std::vector<Eigen::Vector3d> points_C;
  points_C.reserve(pixels.size());
  for (uint32_t pixel : pixels) points_C.push_back(PointAt(image, pixel));
  for (double edge_m = kFinestSample_m;; edge_m *= 1.15) {
    auto means = VoxelMeans(points_C, edge_m);
    if (static_cast<int>(means.size()) <= most) return means;
    // A surface's voxels grow fewer with the square of their edge: go near at once.
    edge_m *= std::max(1.0, 0.9 * std::sqrt(static_cast<double>(means.size()) / most));
  }
}

}  // namespace beckon::perception
