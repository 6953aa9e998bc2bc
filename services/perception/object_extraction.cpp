// Gathers each object's pixels, then measures them.
#include "services/perception/object_extraction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace beckon::perception {
namespace {

constexpr double kFinestSample_m = 0.002;
constexpr int kCloses_px = 2;  // gaps of depth that an outline passes over

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

/// Twice the signed area; positive where the polygon runs clockwise as seen (v points down).
double TwiceArea(const std::vector<cv::Point>& polygon) {
  double sum = 0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const auto& a = polygon[i];
    const auto& b = polygon[(i + 1) % polygon.size()];
    sum += static_cast<double>(a.x) * b.y - static_cast<double>(b.x) * a.y;
  }
  return sum;
}

/// The largest outer contour of the object's pixels, small gaps closed, simplified until it has few
/// enough vertices.
std::vector<std::array<int16_t, 2>> Outline(const RgbdImage& image,
                                            const std::vector<uint32_t>& pixels) {
  int left = image.width, right = 0, top = image.height, bottom = 0;
  for (uint32_t pixel : pixels) {
    const int u = static_cast<int>(pixel) % image.width, v = static_cast<int>(pixel) / image.width;
    left = std::min(left, u), right = std::max(right, u);
    top = std::min(top, v), bottom = std::max(bottom, v);
  }
  left -= kCloses_px, right += kCloses_px, top -= kCloses_px, bottom += kCloses_px;
  cv::Mat mask = cv::Mat::zeros(bottom - top + 1, right - left + 1, CV_8U);
  for (uint32_t pixel : pixels) {
    mask.at<uint8_t>(static_cast<int>(pixel) / image.width - top,
                     static_cast<int>(pixel) % image.width - left) = 255;
  }
  cv::morphologyEx(mask, mask, cv::MORPH_CLOSE,
                   cv::Mat::ones(2 * kCloses_px + 1, 2 * kCloses_px + 1, CV_8U));
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(mask, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE, {left, top});
  const auto largest = std::max_element(
      contours.begin(), contours.end(),
      [](const auto& a, const auto& b) { return std::abs(TwiceArea(a)) < std::abs(TwiceArea(b)); });
  if (largest == contours.end()) return {};
  std::vector<cv::Point> polygon;
  for (double tolerance_px = 1;; tolerance_px *= 1.5) {
    cv::approxPolyDP(*largest, polygon, tolerance_px, true);
    if (static_cast<int>(polygon.size()) <= kMaxOutline) break;
  }
  if (TwiceArea(polygon) < 0) std::reverse(polygon.begin(), polygon.end());
  std::vector<std::array<int16_t, 2>> outline;
  for (const auto& p : polygon) {
    outline.push_back({static_cast<int16_t>(p.x), static_cast<int16_t>(p.y)});
  }
  return outline;
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
                                            const Segmentation& segmentation, const Pose& X_WC) {
  if (!segmentation.table_C) return {};
  std::vector<ExtractedObject> objects(segmentation.n_objects);
  for (uint32_t pixel = 0; pixel < segmentation.labels.size(); ++pixel) {
    if (const int k = segmentation.labels[pixel]; k > 0) objects[k - 1].pixels.push_back(pixel);
  }
  for (auto& object : objects) {
    Measure(image, X_WC, object);
    object.outline_px = Outline(image, object.pixels);
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
