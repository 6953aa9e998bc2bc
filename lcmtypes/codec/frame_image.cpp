// Compression and decompression of a frame's images.
#include "lcmtypes/frame_image.h"

#include <algorithm>
#include <cmath>
#include <iterator>
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

struct ImageSize {
  int width = 0;
  int height = 0;
};

int BigEndian16(const std::vector<uint8_t>& bytes, size_t at) {
  return bytes[at] << 8 | bytes[at + 1];
}

/// The size in a PNG's first chunk, which must be its IHDR: libpng passes over others before it.
ImageSize PngSize(const std::vector<uint8_t>& bytes) {
  constexpr size_t kHeader = 24;
  constexpr uint8_t kIhdr[] = {'I', 'H', 'D', 'R'};
  if (bytes.size() < kHeader || !std::equal(std::begin(kIhdr), std::end(kIhdr), &bytes[12]) ||
      BigEndian16(bytes, 16) != 0 || BigEndian16(bytes, 20) != 0) {
    return {};
  }
  return {BigEndian16(bytes, 18), BigEndian16(bytes, 22)};
}

/// The size in a JPEG's start-of-frame segment. Before it there may be segments only, each right
/// behind the other: markers without a length and bytes that fill up are legal there, but they
/// would let a file show this reader another start of frame than the decoder.
ImageSize JpegSize(const std::vector<uint8_t>& bytes) {
  for (size_t at = 2; at + 9 <= bytes.size() && bytes[at] == 0xff;) {
    const int marker = bytes[at + 1], length = BigEndian16(bytes, at + 2);
    const bool is_table = marker == 0xc4 || marker == 0xcc;
    if (marker >= 0xc0 && marker <= 0xcf && !is_table) {
      return {BigEndian16(bytes, at + 7), BigEndian16(bytes, at + 5)};
    }
    const bool is_segment = is_table || (marker >= 0xdb && marker <= 0xfe);
    if (!is_segment || length < 2) return {};
    at += 2 + static_cast<size_t>(length);
  }
  return {};
}

/// The size a PNG or a JPEG claims; 0 x 0 for anything else. Known before decoding, so that a small
/// file cannot claim gigabytes.
ImageSize ClaimedSize(const std::vector<uint8_t>& bytes) {
  if (bytes.size() >= 2 && bytes[0] == 0x89 && bytes[1] == 'P') return PngSize(bytes);
  if (bytes.size() >= 2 && BigEndian16(bytes, 0) == 0xffd8) return JpegSize(bytes);
  return {};
}

/// Whether a JPEG has more scans than any encoder writes (about ten): each costs a pass over the
/// whole image, however few bytes it has. Compressed data cannot hold the marker.
bool HasTooManyScans(const std::vector<uint8_t>& bytes) {
  constexpr int kMostScans = 100;
  if (bytes.size() < 2 || BigEndian16(bytes, 0) != 0xffd8) return false;
  int n = 0;
  for (size_t i = 0; i + 1 < bytes.size(); ++i) n += BigEndian16(bytes, i) == 0xffda;
  return n > kMostScans;
}

Result<cv::Mat> Decompress(const std::vector<uint8_t>& bytes, int type, const msg::Frame& frame,
                           const char* name) {
  const std::string image_name = std::string("frame: ") + name + " image";
  const ImageSize claimed = ClaimedSize(bytes);
  if (claimed.width != frame.width || claimed.height != frame.height) {
    return Error{image_name + " is " + std::to_string(claimed.width) + "x" +
                 std::to_string(claimed.height) + ", the frame says " +
                 std::to_string(frame.width) + "x" + std::to_string(frame.height)};
  }
  if (HasTooManyScans(bytes)) return Error{image_name + " is a JPEG of more than 100 scans"};
  cv::Mat image;
  try {
    image = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception& e) {
    return Error{image_name + " does not decode: " + e.err};
  }
  if (image.type() != type || image.cols != frame.width || image.rows != frame.height) {
    return Error{image_name + " does not decode to what the frame says"};
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
