// The outline in the image: fill, hollows, holes, symmetry, widths over the rows.
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "services/perception/cue_crop.h"
#include "services/perception/cue_shape_measures.h"

namespace beckon::perception {
namespace {

constexpr int kSize = 96;  // px of the crop that is measured

struct Contour {
  std::vector<cv::Point> points;
  double area = 0;
  double hole_area = 0;  // of all holes in it
};

Contour LargestContour(const cv::Mat& mask) {
  std::vector<std::vector<cv::Point>> contours;
  std::vector<cv::Vec4i> links;
  cv::findContours(mask, contours, links, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
  Contour best;
  for (size_t i = 0; i < contours.size(); ++i) {
    const double area = cv::contourArea(contours[i]);
    if (links[i][3] >= 0) {
      best.hole_area += area;
    } else if (area > best.area || best.points.empty()) {
      best.area = area;
      best.points = contours[i];
    }
  }
  return best;
}

/// Depths of the two deepest hollows of the outline, px.
std::pair<float, float> DeepestHollows(const std::vector<cv::Point>& contour) {
  std::vector<int> hull;
  std::vector<cv::Vec4i> defects;
  cv::convexHull(contour, hull);
  if (hull.size() > 3 && contour.size() > 4) {
    std::sort(hull.begin(), hull.end());  // convexityDefects wants them in order
    cv::convexityDefects(contour, hull, defects);
  }
  float first = 0, second = 0;
  for (const cv::Vec4i& defect : defects) {
    const float depth = static_cast<float>(defect[3]) / 256;
    second = std::max(second, std::min(first, depth));
    first = std::max(first, depth);
  }
  return {first, second};
}

void MeasureRows(const cv::Mat& mask, const cv::Rect& box, std::vector<float>& out) {
  constexpr int kBands = 8;
  for (int band = 0; band < kBands; ++band) {
    const int row = box.y + (2 * band + 1) * box.height / (2 * kBands);
    const int filled = cv::countNonZero(mask.row(std::clamp(row, 0, kSize - 1)));
    out.push_back(static_cast<float>(filled) / static_cast<float>(std::max(1, box.width)));
  }
}

}  // namespace

void MeasureOutline(const CueView& view, std::vector<float>& out) {
  cv::Mat mask;
  cv::threshold(CropMask(view, kSize), mask, 127, 255, cv::THRESH_BINARY);
  const Contour contour = LargestContour(mask);
  if (contour.points.empty()) {
    out.insert(out.end(), 18, 0.0F);
    return;
  }
  std::vector<cv::Point> hull;
  cv::convexHull(contour.points, hull);
  const cv::Rect box = cv::boundingRect(contour.points);
  const double hull_area = std::max(1.0, cv::contourArea(hull));
  const double perimeter = cv::arcLength(contour.points, true);
  const cv::RotatedRect tight = cv::minAreaRect(contour.points);
  const auto [first, second] = DeepestHollows(contour.points);
  cv::Mat flipped, difference;
  cv::flip(mask(box), flipped, 1);
  cv::absdiff(mask(box), flipped, difference);
  const double asymmetry = cv::countNonZero(difference) / std::max(1.0, contour.area);
  const double distance_m = view.origin_C.norm();
  const double px_to_m = std::max(view.box_width, view.box_height) / (0.875 * kSize) * distance_m /
                         view.object.image.intrinsics.fx;
  const double values[] = {contour.area / hull_area,
                           contour.area / std::max(1, box.area()),
                           contour.area / std::max(1.0F, tight.size.area()),
                           static_cast<double>(box.width) / std::max(1, box.height),
                           perimeter * perimeter / std::max(1.0, contour.area),
                           contour.hole_area / hull_area,
                           first / std::sqrt(hull_area),
                           first * px_to_m,
                           second / std::sqrt(hull_area),
                           asymmetry};
  for (const double value : values) out.push_back(static_cast<float>(value));
  MeasureRows(mask, box, out);
}

}  // namespace beckon::perception
