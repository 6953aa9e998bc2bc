#include "services/capture/image_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace beckon::capture {
namespace {

Status Write(const std::string& path, const cv::Mat& image) {
  try {
    if (cv::imwrite(path, image, {cv::IMWRITE_PNG_COMPRESSION, 3})) return {};
  } catch (const cv::Exception&) {  // reported below
  }
  return Error{path + ": cannot be written"};
}

cv::Mat View(int width, int height, int type, const void* pixels) {
  return {height, width, type, const_cast<void*>(pixels)};
}

}  // namespace

Status WriteColourPng(const std::string& path, int width, int height,
                      const std::vector<Rgb>& pixels) {
  std::vector<Rgb> bgr(pixels.size());
  std::transform(pixels.begin(), pixels.end(), bgr.begin(), [](const Rgb& p) {
    return Rgb{p[2], p[1], p[0]};
  });
  return Write(path, View(width, height, CV_8UC3, bgr.data()));
}

Status WriteGreyPng(const std::string& path, int width, int height,
                    const std::vector<uint8_t>& pixels) {
  return Write(path, View(width, height, CV_8UC1, pixels.data()));
}

Status Write16BitPng(const std::string& path, int width, int height,
                     const std::vector<uint16_t>& pixels) {
  return Write(path, View(width, height, CV_16UC1, pixels.data()));
}

std::vector<uint16_t> Millimetres(const std::vector<float>& depth_m) {
  std::vector<uint16_t> out(depth_m.size());
  std::transform(depth_m.begin(), depth_m.end(), out.begin(), [](float depth) {
    return static_cast<uint16_t>(std::clamp(std::round(1000 * depth), 0.0f, 65535.0f));
  });
  return out;
}

Status MakeFolder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error || !std::filesystem::is_directory(path, error)) {
    return Error{path + ": the folder cannot be made: " + error.message()};
  }
  return {};
}

Status WriteText(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.flush();
  if (!file) return Error{path + ": cannot be written"};
  return {};
}

}  // namespace beckon::capture
