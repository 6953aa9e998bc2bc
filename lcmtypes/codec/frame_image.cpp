// Compression and decompression of a frame's images.
#include "lcmtypes/frame_image.h"

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace beckon {
namespace {

constexpr int kFastPng = 1;

/// The image as OpenCV keeps it: three bytes a pixel.
cv::Mat View(const std::vector<Rgb>& colour, int width, int height) {
  return {height, width, CV_8UC3, const_cast<Rgb*>(colour.data())};
}

Result<cv::Mat> Decompress(const std::vector<uint8_t>& bytes, int type, const msg::Frame& frame,
                           const char* name) {
  cv::Mat image;
  try {
    image = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception& e) {
    return Error{std::string("frame: ") + name + " image does not decode: " + e.err};
  }
  if (image.empty()) return Error{std::string("frame: ") + name + " image does not decode"};
  if (image.type() != type)
    return Error{std::string("frame: ") + name + " image has another pixel type than expected"};
  if (image.cols != frame.width || image.rows != frame.height) {
    return Error{std::string("frame: ") + name + " image is " + std::to_string(image.cols) + "x" +
                 std::to_string(image.rows) + ", the frame says " + std::to_string(frame.width) +
                 "x" + std::to_string(frame.height)};
  }
  return image;
}

}  // namespace

Status EncodeImage(const RgbdImage& image, double depth_unit_m, int jpeg_quality,
                   msg::Frame& frame) {
  const size_t pixels = static_cast<size_t>(image.width) * image.height;
  if (pixels == 0 || image.depth_m.size() != pixels ||
      (!image.colour.empty() && image.colour.size() != pixels)) {
    return Error{"frame: the image's sizes disagree (" + std::to_string(image.width) + "x" +
                 std::to_string(image.height) + ", " + std::to_string(image.depth_m.size()) +
                 " depths, " + std::to_string(image.colour.size()) + " colours)"};
  }
  cv::Mat depth(image.height, image.width, CV_16UC1);
  for (size_t i = 0; i < pixels; ++i) {
    const double counts = std::round(image.depth_m[i] / depth_unit_m);
    depth.ptr<uint16_t>()[i] = counts >= 1 && counts <= 65535 ? static_cast<uint16_t>(counts) : 0;
  }
  frame.width = image.width;
  frame.height = image.height;
  frame.intrinsics = image.intrinsics;
  frame.depth_unit_m = depth_unit_m;
  frame.depth_codec = msg::DepthCodec::kPng;
  cv::imencode(".png", depth, frame.depth, {cv::IMWRITE_PNG_COMPRESSION, kFastPng});
  frame.colour.clear();
  frame.colour_codec = msg::ColourCodec::kNone;
  if (!image.colour.empty()) {
    cv::Mat bgr;
    cv::cvtColor(View(image.colour, image.width, image.height), bgr, cv::COLOR_RGB2BGR);
    cv::imencode(".jpg", bgr, frame.colour, {cv::IMWRITE_JPEG_QUALITY, jpeg_quality});
    frame.colour_codec = msg::ColourCodec::kJpeg;
  }
  return {};
}

Result<RgbdImage> DecodeImage(const msg::Frame& frame) {
  const auto depth = Decompress(frame.depth, CV_16UC1, frame, "depth");
  if (!depth) return depth.error();
  RgbdImage image;
  image.width = frame.width;
  image.height = frame.height;
  image.intrinsics = frame.intrinsics;
  const size_t pixels = static_cast<size_t>(frame.width) * frame.height;
  image.depth_m.resize(pixels);
  for (size_t i = 0; i < pixels; ++i) {
    image.depth_m[i] = static_cast<float>(depth->ptr<uint16_t>()[i] * frame.depth_unit_m);
  }
  if (frame.colour_codec == msg::ColourCodec::kNone) return image;
  const auto bgr = Decompress(frame.colour, CV_8UC3, frame, "colour");
  if (!bgr) return bgr.error();
  image.colour.resize(pixels);
  cv::cvtColor(*bgr, View(image.colour, image.width, image.height), cv::COLOR_BGR2RGB);
  return image;
}

}  // namespace beckon
