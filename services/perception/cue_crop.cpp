// Cutting the object out of the image.
#include "services/perception/cue_crop.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace beckon::perception {
namespace {

constexpr int kMaxBox = 2048;  // px; larger boxes are seen every other pixel, and so on

cv::Mat BoxMask(const CueView& view) {
  return cv::Mat(view.box_height, view.box_width, CV_8U, const_cast<uint8_t*>(view.mask.data()))
      .clone();
}

/// Pads to a square with a margin and scales.
cv::Mat Square(const cv::Mat& box, const cv::Scalar& outside, int size) {
  cv::Mat source = box;
  while (std::max(source.cols, source.rows) > kMaxBox) {
    cv::resize(source, source, {(source.cols + 1) / 2, (source.rows + 1) / 2}, 0, 0,
               cv::INTER_AREA);
  }
  const int side = std::max(source.cols, source.rows);
  const int padded = side + 2 * std::max(1, side / 14);
  cv::Mat square(padded, padded, source.type(), outside);
  source.copyTo(square(
      cv::Rect((padded - source.cols) / 2, (padded - source.rows) / 2, source.cols, source.rows)));
  cv::Mat out;
  cv::resize(square, out, {size, size}, 0, 0, padded > size ? cv::INTER_AREA : cv::INTER_LINEAR);
  return out;
}

float Median(std::vector<float> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<int64_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

cv::Mat CropMask(const CueView& view, int size) {
  cv::Mat mask = BoxMask(view);
  cv::morphologyEx(mask, mask, cv::MORPH_CLOSE, cv::Mat::ones(3, 3, CV_8U));
  return Square(mask, 0, size);
}

cv::Mat CropGrey(const CueView& view, int size) {
  const RgbdImage& image = view.object.image;
  const cv::Mat mask = BoxMask(view);
  cv::Mat grey(mask.size(), CV_8U, cv::Scalar(128));
  if (image.colour.size() == image.depth_m.size()) {
    for (int v = 0; v < grey.rows; ++v) {
      for (int u = 0; u < grey.cols; ++u) {
        const Rgb& c = image.colour[image.Index(view.box_u + u, view.box_v + v)];
        grey.at<uint8_t>(v, u) = static_cast<uint8_t>((77 * c[0] + 150 * c[1] + 29 * c[2]) >> 8);
      }
    }
  }
  const cv::Scalar mean = cv::mean(grey, mask);
  cv::Mat off;
  cv::compare(mask, 0, off, cv::CMP_EQ);
  grey.setTo(mean, off);
  return Square(grey, mean, size);
}

cv::Mat CropDepth(const CueView& view, int size, float half_range_m) {
  const RgbdImage& image = view.object.image;
  const cv::Mat mask = BoxMask(view);
  std::vector<float> depths;
  for (const uint32_t pixel : view.object.pixels) {
    if (pixel < image.depth_m.size() && image.depth_m[pixel] > 0) {
      depths.push_back(image.depth_m[pixel]);
    }
  }
  const float middle = Median(std::move(depths));
  cv::Mat depth(mask.size(), CV_8U, cv::Scalar(0));  // bright is near, as the eye expects
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const float z = image.depth_m[image.Index(view.box_u + u, view.box_v + v)];
      if (mask.at<uint8_t>(v, u) == 0 || z <= 0) continue;
      const float nearness = 0.5F - (z - middle) / (2 * half_range_m);
      depth.at<uint8_t>(v, u) = static_cast<uint8_t>(std::clamp(nearness, 0.05F, 1.0F) * 255);
    }
  }
  cv::morphologyEx(depth, depth, cv::MORPH_CLOSE, cv::Mat::ones(3, 3, CV_8U));
  return Square(depth, 0, size);
}

}  // namespace beckon::perception
