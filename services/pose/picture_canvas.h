// The canvas of a picture: lines, areas, dots and letters in px of the finished picture, smooth.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

#include "services/base/result.h"

namespace beckon::pose {

using Colour = cv::Scalar;                        // blue, green, red, 0..255
using PicturePolygon = std::vector<cv::Point2d>;  // px

/// `colour` mixed with white: 0 is the colour itself, 1 white.
Colour Lighter(const Colour& colour, double amount);

/// Colours that the colour-blind tell apart, for things that are counted (Okabe & Ito's palette).
Colour DistinctColour(size_t number);

/// Pixels at kFine times the finished resolution. Copies share them, as cv::Mat does. What lies
/// outside is cut off.
class Canvas {
 public:
  static constexpr int kFine = 2;

  Canvas(int width_px, int height_px, const Colour& paper);
  /// Over a picture, enlarged to `zoom` times its size.
  Canvas(const cv::Mat& picture, double zoom);

  double width_px() const { return static_cast<double>(pixels_.cols) / kFine; }
  double height_px() const { return static_cast<double>(pixels_.rows) / kFine; }

  /// A part of this canvas with coordinates of its own; it draws on the same pixels.
  Canvas Part(const cv::Rect& area_px) const;
  Canvas Copy() const;
  /// White of the same size.
  Canvas White() const;
  /// Lets what `drawn` has shine through: 0 leaves this canvas as it is, 1 takes all of `drawn`.
  void Blend(const Canvas& drawn, double opacity);

  void Line(const cv::Point2d& a, const cv::Point2d& b, const Colour& colour, double width_px);
  void Arrow(const cv::Point2d& from, const cv::Point2d& to, const Colour& colour, double width_px,
             double head_px);
  void Fill(const PicturePolygon& polygon, const Colour& colour);
  void Dot(const cv::Point2d& centre, double radius_px, const Colour& colour);

  /// Letters of a height; `baseline_left` is where they begin. Characters beyond ASCII become '?'.
  void Text(const std::string& text, const cv::Point2d& baseline_left, double height_px,
            const Colour& colour);
  /// The same on a rim of white, to be read over anything.
  void TextOnAnything(const std::string& text, const cv::Point2d& baseline_left, double height_px,
                      const Colour& colour);
  static double TextWidth(const std::string& text, double height_px);
  /// `text` cut to a width, "..." at its end where it was cut.
  static std::string Fitted(const std::string& text, double height_px, double width_px);

  /// The finished picture, smooth.
  cv::Mat Finished() const;

 private:
  explicit Canvas(cv::Mat pixels) : pixels_(std::move(pixels)) {}

  cv::Mat pixels_;
};

/// Writes a picture to a file whose extension tells the format.
Status WritePicture(const std::string& path, const cv::Mat& picture);

}  // namespace beckon::pose
