// The canvas of a picture: lines, areas, dots and letters in px of the finished picture, smooth.
#include "services/pose/picture_canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace beckon::pose {
namespace {

constexpr int kShift = 4;  // fractional bits of OpenCV's coordinates
constexpr int kFont = cv::FONT_HERSHEY_DUPLEX;
constexpr double kFontHeight_px = 21;  // of a capital at scale 1
constexpr double kFarthest_px = 1e5;   // beyond, OpenCV's integers might overflow

bool Drawable(const cv::Point2d& p) {
  return std::abs(p.x) < kFarthest_px && std::abs(p.y) < kFarthest_px;  // false for NaN
}

cv::Point Fixed(const cv::Point2d& p) {
  constexpr double kUnits = Canvas::kFine * (1 << kShift);
  return {cvRound(p.x * kUnits), cvRound(p.y * kUnits)};
}

int Thickness(double width_px) { return std::max(1, cvRound(width_px * Canvas::kFine)); }

double FontScale(double height_px) { return height_px * Canvas::kFine / kFontHeight_px; }

}  // namespace

Colour Lighter(const Colour& colour, double amount) {
  return colour * (1 - amount) + Colour::all(255) * amount;
}

Colour DistinctColour(size_t number) {
  static const std::array<Colour, 6> kColours = {Colour(178, 114, 0),  Colour(0, 159, 230),
                                                 Colour(115, 158, 0),  Colour(167, 121, 204),
                                                 Colour(233, 180, 86), Colour(0, 94, 213)};
  return kColours[number % kColours.size()];
}

Canvas::Canvas(int width_px, int height_px, const Colour& paper)
    : pixels_(height_px * kFine, width_px * kFine, CV_8UC3, paper) {}

Canvas::Canvas(const cv::Mat& picture, double zoom) {
  cv::resize(picture, pixels_, {}, zoom * kFine, zoom * kFine, cv::INTER_LINEAR);
}

Canvas Canvas::Part(const cv::Rect& area_px) const {
  const cv::Rect area(area_px.x * kFine, area_px.y * kFine, area_px.width * kFine,
                      area_px.height * kFine);
  return Canvas(pixels_(area & cv::Rect(0, 0, pixels_.cols, pixels_.rows)));
}

Canvas Canvas::Copy() const { return Canvas(pixels_.clone()); }

Canvas Canvas::White() const {
  return Canvas(cv::Mat(pixels_.size(), pixels_.type(), Colour::all(255)));
}

void Canvas::Blend(const Canvas& drawn, double opacity) {
  cv::addWeighted(drawn.pixels_, opacity, pixels_, 1 - opacity, 0, pixels_);
}

void Canvas::Line(const cv::Point2d& a, const cv::Point2d& b, const Colour& colour,
                  double width_px) {
  if (!Drawable(a) || !Drawable(b)) return;
  cv::line(pixels_, Fixed(a), Fixed(b), colour, Thickness(width_px), cv::LINE_AA, kShift);
}

void Canvas::Arrow(const cv::Point2d& from, const cv::Point2d& to, const Colour& colour,
                   double width_px, double head_px) {
  const cv::Point2d along = to - from;
  const double length = std::hypot(along.x, along.y);
  if (!(length > 1e-9)) return;
  const double head = std::min(head_px, length);
  const cv::Point2d back = along * (head / length), across(-back.y * 0.45, back.x * 0.45);
  Line(from, to - back * 0.8, colour, width_px);
  Fill({to, to - back + across, to - back - across}, colour);
}

void Canvas::Fill(const PicturePolygon& polygon, const Colour& colour) {
  if (!std::all_of(polygon.begin(), polygon.end(), Drawable)) return;
  std::vector<cv::Point> fixed;
  for (const auto& p : polygon) fixed.push_back(Fixed(p));
  cv::fillConvexPoly(pixels_, fixed, colour, cv::LINE_AA, kShift);
}

void Canvas::Dot(const cv::Point2d& centre, double radius_px, const Colour& colour) {
  if (!Drawable(centre)) return;
  cv::circle(pixels_, Fixed(centre), cvRound(radius_px * kFine * (1 << kShift)), colour, cv::FILLED,
             cv::LINE_AA, kShift);
}

void Canvas::Text(const std::string& text, const cv::Point2d& baseline_left, double height_px,
                  const Colour& colour) {
  if (!Drawable(baseline_left)) return;
  cv::putText(pixels_, text, baseline_left * kFine, kFont, FontScale(height_px), colour,
              Thickness(height_px / 18), cv::LINE_AA);
}

void Canvas::TextOnAnything(const std::string& text, const cv::Point2d& baseline_left,
                            double height_px, const Colour& colour) {
  if (!Drawable(baseline_left)) return;
  cv::putText(pixels_, text, baseline_left * kFine, kFont, FontScale(height_px), Colour::all(255),
              Thickness(height_px / 18 + 2), cv::LINE_AA);
  Text(text, baseline_left, height_px, colour);
}

double Canvas::TextWidth(const std::string& text, double height_px) {
  return static_cast<double>(
             cv::getTextSize(text, kFont, FontScale(height_px), Thickness(height_px / 18), nullptr)
                 .width) /
         kFine;
}

std::string Canvas::Fitted(const std::string& text, double height_px, double width_px) {
  if (TextWidth(text, height_px) <= width_px) return text;
  for (size_t length = text.size(); length-- > 0;) {
    std::string cut = text.substr(0, length) + "...";
    if (TextWidth(cut, height_px) <= width_px) return cut;
  }
  return "";
}

cv::Mat Canvas::Finished() const {
  cv::Mat finished;
  cv::resize(pixels_, finished, {}, 1.0 / kFine, 1.0 / kFine, cv::INTER_AREA);
  return finished;
}

Status WritePicture(const std::string& path, const cv::Mat& picture) {
  bool written = false;
  try {
    written = cv::imwrite(path, picture);
  } catch (const cv::Exception&) {  // an extension that is no image's
  }
  if (!written) return Error{path + ": cannot be written; expected the name of a .png file"};
  return {};
}

}  // namespace beckon::pose
