// Contours by OpenCV.
#include "services/perception/object_outline.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace beckon::perception {
namespace {

constexpr double kSmooth_px = 1.5;  // of the blur that evens ragged outlines and closes small gaps
constexpr int kMargin_px = 2;
constexpr double kChanged = 0.01;  // part of a silhouette that changed: its outline is drawn anew
constexpr size_t kChanged_px = 3;  // but no fewer pixels

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

/// The pixels as a picture of their bounding box with a margin, and where its corner is.
std::pair<cv::Mat, cv::Point> Mask(int width, std::span<const uint32_t> pixels) {
  cv::Rect box;
  int left = width, right = 0;
  for (uint32_t pixel : pixels) {
    const int u = static_cast<int>(pixel) % width;
    left = std::min(left, u), right = std::max(right, u);
  }
  const int top = static_cast<int>(pixels.front()) / width - kMargin_px;
  const int bottom = static_cast<int>(pixels.back()) / width + kMargin_px;
  left -= kMargin_px, right += kMargin_px;
  cv::Mat mask = cv::Mat::zeros(bottom - top + 1, right - left + 1, CV_8U);
  for (uint32_t pixel : pixels) {
    mask.at<uint8_t>(static_cast<int>(pixel) / width - top,
                     static_cast<int>(pixel) % width - left) = 255;
  }
  return {mask, {left, top}};
}

std::vector<cv::Point> LargestContour(const cv::Mat& mask, const cv::Point& corner) {
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(mask, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE, corner);
  const auto largest = std::max_element(
      contours.begin(), contours.end(),
      [](const auto& a, const auto& b) { return std::abs(TwiceArea(a)) < std::abs(TwiceArea(b)); });
  return largest == contours.end() ? std::vector<cv::Point>() : *largest;
}

/// How many pixels only one of two ascending lists has.
size_t Difference(std::span<const uint32_t> a, std::span<const uint32_t> b) {
  size_t common = 0;
  for (size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    if (a[i] == b[j]) ++common;
    const bool next_a = a[i] <= b[j], next_b = b[j] <= a[i];
    i += next_a, j += next_b;
  }
  return a.size() + b.size() - 2 * common;
}

}  // namespace

std::vector<std::array<int16_t, 2>> DrawOutline(int width, std::span<const uint32_t> pixels) {
  if (pixels.empty()) return {};
  const auto [mask, corner] = Mask(width, pixels);
  cv::Mat smooth;
  cv::GaussianBlur(mask, smooth, {}, kSmooth_px);
  auto contour = LargestContour(smooth >= 128, corner);
  if (contour.empty()) contour = LargestContour(mask, corner);  // all of it is thin
  std::vector<cv::Point> polygon;
  for (double tolerance_px = 0.6;; tolerance_px *= 1.3) {
    cv::approxPolyDP(contour, polygon, tolerance_px, true);
    if (static_cast<int>(polygon.size()) <= kMaxOutline) break;
  }
  if (TwiceArea(polygon) < 0) std::reverse(polygon.begin(), polygon.end());
  std::vector<std::array<int16_t, 2>> outline;
  for (const auto& p : polygon) {
    outline.push_back({static_cast<int16_t>(p.x), static_cast<int16_t>(p.y)});
  }
  return outline;
}

void OutlineMemory::Draw(int width, std::span<const int> ids, std::span<ExtractedObject> objects) {
  std::map<int, Drawn> last = std::move(drawn_);
  drawn_.clear();
  if (width != width_) last.clear();
  width_ = width;
  for (size_t k = 0; k < objects.size(); ++k) {
    ExtractedObject& object = objects[k];
    Drawn& drawn = drawn_[ids[k]];
    drawn = std::move(last[ids[k]]);
    const auto part = static_cast<size_t>(kChanged * static_cast<double>(drawn.silhouette.size()));
    if (drawn.silhouette.empty() ||
        Difference(drawn.silhouette, object.silhouette) > std::max(kChanged_px, part)) {
      drawn = {object.silhouette, DrawOutline(width, object.silhouette)};
    }
    object.outline_px = drawn.outline_px;
  }
}

}  // namespace beckon::perception
