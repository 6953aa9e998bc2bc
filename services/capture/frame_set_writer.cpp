#include "services/capture/frame_set_writer.h"

#include <array>
#include <cstdio>
#include <limits>

#include "services/base/cloud_file.h"
#include "services/capture/description_json.h"
#include "services/capture/embedded_scene.h"
#include "services/capture/image_files.h"

namespace beckon::capture {
namespace {

Cloud ToCloud(const EmbeddedFrame& frame) {
  const RgbdImage& image = frame.image;
  Cloud cloud;
  cloud.width = image.width;
  cloud.height = image.height;
  cloud.points.assign(image.depth_m.size(),
                      Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      if (image.HasDepth(u, v)) cloud.points[image.Index(u, v)] = image.Point(u, v).cast<float>();
    }
  }
  cloud.colours = image.colour;
  cloud.labels.assign(frame.labels.begin(), frame.labels.end());
  return cloud;
}

Status WriteFrame(const std::string& stem, const EmbeddedFrame& frame) {
  const int w = frame.image.width, h = frame.image.height;
  if (auto status = WritePcdFile(stem + ".pcd", ToCloud(frame)); !status) return status;
  if (auto status = WriteColourPng(stem + "_rgb.png", w, h, frame.image.colour); !status)
    return status;
  if (auto status = Write16BitPng(stem + "_depth.png", w, h, Millimetres(frame.image.depth_m));
      !status)
    return status;
  if (auto status = Write16BitPng(stem + "_labels.png", w, h, frame.labels); !status) return status;
  return WriteText(stem + "_truth.json", ToJson(frame.description));
}

}  // namespace

Status WriteFrameSet(const std::string& folder, uint64_t seed, int frames) {
  if (auto status = MakeFolder(folder); !status) return status;
  for (int i = 0; i < frames; ++i) {
    std::array<char, 16> number{};
    std::snprintf(number.data(), number.size(), "%04d", i);
    const auto frame = RenderEmbeddedScene(FrameSeed(seed, static_cast<uint64_t>(i)));
    if (auto status = WriteFrame(folder + "/" + number.data(), frame); !status) return status;
  }
  return {};
}

}  // namespace beckon::capture
