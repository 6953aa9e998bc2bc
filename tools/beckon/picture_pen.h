// Letters and sizes that the parts of a demo's picture share.
#pragma once

#include <opencv2/imgproc.hpp>
#include <string>

namespace beckon::tool {

/// Everything is drawn at this many times its size and then made smaller: smooth lines and letters.
inline constexpr int kFine = 2;
inline const cv::Scalar kInk(45, 38, 32), kWhite(255, 255, 255);  // blue, green, red

/// Letters of a height in px of the finished picture.
struct Pen {
  double height_px = 14;
  cv::Scalar colour = kInk;
  int thickness = 1;

  double scale() const { return height_px * kFine / 21.0; }
  cv::Size Measure(const std::string& text) const {
    int below = 0;
    cv::Size size =
        cv::getTextSize(text, cv::FONT_HERSHEY_DUPLEX, scale(), thickness * kFine, &below);
    return {size.width, size.height + below};
  }
  void Write(cv::Mat& canvas, const std::string& text, cv::Point top_left) const {
    const int ascent =
        cv::getTextSize(text, cv::FONT_HERSHEY_DUPLEX, scale(), thickness * kFine, nullptr).height;
    cv::putText(canvas, text, {top_left.x, top_left.y + ascent}, cv::FONT_HERSHEY_DUPLEX, scale(),
                colour, thickness * kFine, cv::LINE_AA);
  }
};

}  // namespace beckon::tool
