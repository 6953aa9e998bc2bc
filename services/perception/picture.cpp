// Pictures by OpenCV.
#include "services/perception/picture.h"

#include <algorithm>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace beckon::perception {
namespace {

const cv::Scalar kTableColour(255, 255, 255);
constexpr double kTextScale = 0.42;

/// Colours that stay apart for neighbouring ids (multiples of the golden angle around the hue
/// circle).
cv::Scalar ColourOf(int id) {
  cv::Mat hsv(1, 1, CV_8UC3, cv::Scalar((id * 68) % 180, 200, 255)), bgr;
  cv::cvtColor(hsv, bgr, cv::COLOR_HSV2BGR);
  const auto& c = bgr.at<cv::Vec3b>(0, 0);
  return {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])};
}

cv::Mat Background(const RgbdImage& image) {
  cv::Mat canvas(image.height, image.width, CV_8UC3);
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const size_t i = image.Index(u, v);
      auto& pixel = canvas.at<cv::Vec3b>(v, u);
      if (!image.colour.empty()) {
        const Rgb& c = image.colour[i];
        pixel = {c[2], c[1], c[0]};
      } else {
        const auto grey = cv::saturate_cast<uint8_t>(255 - 80 * image.depth_m[i]);
        pixel = image.depth_m[i] > 0 ? cv::Vec3b(grey, grey, grey) : cv::Vec3b(0, 0, 0);
      }
    }
  }
  return canvas;
}

std::string Caption(const PerceivedObject& object) {
  if (!object.categorised) return std::to_string(object.id);
  char text[128];
  const auto& [name, probability] = object.category.probabilities.front();
  std::snprintf(text, sizeof text, "%d %s %.2f%s", object.id, name.c_str(),
                object.category.confidence, object.category.ask_user ? "?" : "");
  return text;
}

void DrawTable(const RgbdImage& image, const std::vector<Eigen::Vector3d>& hull_C,
               cv::Mat& canvas) {
  std::vector<cv::Point> polygon;
  for (const auto& p_C : hull_C) {
    if (p_C.z() < 0.05) return;  // behind the camera
    const Eigen::Vector2d uv = image.intrinsics.Project(p_C);
    polygon.emplace_back(cvRound(uv.x()), cvRound(uv.y()));
  }
  if (!polygon.empty()) cv::polylines(canvas, polygon, true, kTableColour, 1, cv::LINE_AA);
}

void DrawOutline(const PerceivedObject& object, cv::Mat& canvas) {
  std::vector<cv::Point> polygon;
  for (const auto& [u, v] : object.shape.outline_px) polygon.emplace_back(u, v);
  cv::polylines(canvas, polygon, true, ColourOf(object.id), 2, cv::LINE_AA);
}

/// Above the object, or as far down from there as it takes not to cover another caption.
void DrawCaption(const PerceivedObject& object, std::vector<cv::Rect>& taken, cv::Mat& canvas) {
  std::vector<cv::Point> polygon;
  for (const auto& [u, v] : object.shape.outline_px) polygon.emplace_back(u, v);
  if (polygon.empty()) return;
  const std::string caption = Caption(object);
  const cv::Rect box = cv::boundingRect(polygon);
  int below = 0;
  const cv::Size text = cv::getTextSize(caption, cv::FONT_HERSHEY_SIMPLEX, kTextScale, 1, &below);
  cv::Rect frame(0, 0, text.width + 4, text.height + below + 4);
  frame.x =
      std::clamp(box.x + (box.width - frame.width) / 2, 0, std::max(0, canvas.cols - frame.width));
  frame.y = std::clamp(box.y - frame.height - 2, 0, std::max(0, canvas.rows - frame.height));
  for (size_t i = 0; i < taken.size(); ++i) {
    if ((taken[i] & frame).empty()) continue;
    frame.y = taken[i].br().y;
    i = static_cast<size_t>(-1);  // look at all of them again
  }
  taken.push_back(frame);
  cv::rectangle(canvas, frame, {0, 0, 0}, cv::FILLED);
  cv::putText(canvas, caption, {frame.x + 2, frame.y + 2 + text.height}, cv::FONT_HERSHEY_SIMPLEX,
              kTextScale, ColourOf(object.id), 1, cv::LINE_AA);
}

/// Lines of text at the lower border, broken between words.
void DrawCaption(const std::vector<std::string>& words, cv::Mat& canvas) {
  std::vector<std::string> lines = {""};
  const auto width = [](const std::string& text) {
    int below = 0;
    return cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kTextScale, 1, &below).width;
  };
  for (const auto& word : words) {
    if (width(lines.back() + word) > canvas.cols - 8) lines.emplace_back();
    lines.back() += word + "  ";
  }
  constexpr int kLine_px = 15;
  const int top = canvas.rows - kLine_px * static_cast<int>(lines.size()) - 4;
  cv::rectangle(canvas, {0, top}, {canvas.cols, canvas.rows}, {0, 0, 0}, cv::FILLED);
  for (size_t i = 0; i < lines.size(); ++i) {
    cv::putText(canvas, lines[i], {4, top + kLine_px * static_cast<int>(i + 1) - 2},
                cv::FONT_HERSHEY_SIMPLEX, kTextScale, kTableColour, 1, cv::LINE_AA);
  }
}

/// The first word, then each step with its time.
std::vector<std::string> Times(const std::string& first, const Perception& perception) {
  std::vector<std::string> words = {first};
  for (const auto& [step, ms] : perception.steps_ms) {
    char text[64];
    std::snprintf(text, sizeof text, "%s %.2f ms", step.c_str(), ms);
    words.emplace_back(text);
  }
  return words;
}

/// Paints regions over the picture, half transparent.
void PaintRegions(const std::vector<uint32_t>& regions, int cell_px, cv::Mat& canvas) {
  const int width = canvas.cols / cell_px, height = canvas.rows / cell_px;
  for (int v = 0; v < height * cell_px; ++v) {
    for (int u = 0; u < width * cell_px; ++u) {
      const uint32_t k = regions[static_cast<size_t>(v / cell_px) * width + u / cell_px];
      if (k == 0) continue;
      const cv::Scalar colour = ColourOf(static_cast<int>(k % 180));
      auto& pixel = canvas.at<cv::Vec3b>(v, u);
      for (int c = 0; c < 3; ++c) {
        pixel[c] = cv::saturate_cast<uint8_t>(0.35 * pixel[c] + 0.65 * colour[c]);
      }
    }
  }
}

Status Write(const std::string& path, const cv::Mat& picture) {
  const std::string message =
      path + ": cannot write the picture; is the folder there, and does the name end in .png?";
  try {
    if (!cv::imwrite(path, picture)) return Error{message};
  } catch (const cv::Exception&) {
    return Error{message};
  }
  return {};
}

}  // namespace

Status WritePicture(const std::string& path, const RgbdImage& image, const Perception& perception) {
  cv::Mat canvas = Background(image);
  DrawTable(image, perception.segmentation.hull_C, canvas);
  for (const auto& object : perception.objects) DrawOutline(object, canvas);
  std::vector<cv::Rect> taken;
  for (const auto& object : perception.objects) DrawCaption(object, taken, canvas);
  DrawCaption(Times("", perception), canvas);
  return Write(path, canvas);
}

Status WriteStagePicture(const std::string& path, const RgbdImage& image,
                         const SegmentationConfig& config, const Perception& perception,
                         const std::string& stage) {
  cv::Mat canvas = Background(image);
  std::string steps;
  bool reached = false;
  const Segmentation segmentation = Segment(image, config, [&](const StepDone& step) {
    steps += std::string(steps.empty() ? "" : ", ") + step.name;
    if (step.name != stage) return;
    reached = true;
    if (step.regions) PaintRegions(step.regions(), step.cell_px, canvas);
  });
  if (!reached) {
    return Error{"--stage: there is no step '" + stage + "' of the method '" + Name(config.method) +
                 "' on this image; its steps are: " + steps};
  }
  DrawTable(image, segmentation.hull_C, canvas);
  DrawCaption(Times(std::string(Name(config.method)) + ", " + stage + ":", perception), canvas);
  return Write(path, canvas);
}

Status WriteLabels(const std::string& path, const RgbdImage& image, const Perception& perception) {
  cv::Mat labels = cv::Mat::zeros(image.height, image.width, CV_16U);
  for (const auto& object : perception.objects) {
    for (uint32_t pixel : object.shape.pixels) {
      labels.at<uint16_t>(static_cast<int>(pixel) / image.width,
                          static_cast<int>(pixel) % image.width) = static_cast<uint16_t>(object.id);
    }
  }
  return Write(path, labels);
}

}  // namespace beckon::perception
