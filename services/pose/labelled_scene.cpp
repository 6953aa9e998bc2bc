// The objects of an organised scene that an image labels.
#include "services/pose/labelled_scene.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <span>
#include <utility>

#include "services/pose/table_plane.h"

namespace beckon::pose {
namespace {

// What a PNG begins with: 8 bytes of signature, then IHDR with width, height, bit depth, colour
// type.
constexpr std::array<uint8_t, 8> kPngSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr size_t kPngHeader = 26;
constexpr uint8_t kGrey = 0;

uint32_t BigEndian(std::span<const uint8_t> bytes, size_t at) {
  return static_cast<uint32_t>(bytes[at]) << 24 | static_cast<uint32_t>(bytes[at + 1]) << 16 |
         static_cast<uint32_t>(bytes[at + 2]) << 8 | bytes[at + 3];
}

/// Whether chunks (length, type, data, checksum) follow each other up to an IEND, undamaged. libpng
/// would print what it finds.
bool IsWhole(std::span<const uint8_t> png) {
  constexpr uint32_t kEnd = 0x49454e44;  // "IEND"
  for (size_t at = kPngSignature.size(); png.size() - at >= 12;) {
    const uint32_t length = BigEndian(png, at);
    if (length > png.size() - at - 12) return false;
    const auto checked = png.subspan(at + 4, length + 4);
    if (crc32(0, checked.data(), static_cast<uInt>(checked.size())) !=
        BigEndian(png, at + 8 + length)) {
      return false;
    }
    if (BigEndian(png, at + 4) == kEnd) return true;
    at += length + 12;
  }
  return false;
}

/// Refuses what cannot be labels of an image of this size, before memory is taken for it.
Status Check(const std::vector<uint8_t>& png, int width, int height) {
  if (png.size() < kPngHeader ||
      !std::equal(kPngSignature.begin(), kPngSignature.end(), png.begin())) {
    return Error{"is not a PNG image; expected labels as a 16-bit grey PNG"};
  }
  const uint32_t w = BigEndian(png, 16), h = BigEndian(png, 20);
  if (w != static_cast<uint32_t>(width) || h != static_cast<uint32_t>(height)) {
    return Error{"is " + std::to_string(w) + "x" + std::to_string(h) + ", expected the scene's " +
                 std::to_string(width) + "x" + std::to_string(height)};
  }
  if (png[24] != 16 || png[25] != kGrey) {
    return Error{"has " + std::to_string(png[24]) + " bits" +
                 (png[25] == kGrey ? "" : " of colour") + "; expected a 16-bit grey PNG"};
  }
  if (!IsWhole(png)) return Error{"is a damaged PNG image"};
  return {};
}

Result<std::vector<uint16_t>> ReadLabels(const std::string& path, int width, int height) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<uint8_t> png{std::istreambuf_iterator<char>(file), {}};
  if (!file) return Error{path + ": cannot be read"};
  if (Status sound = Check(png, width, height); !sound) {
    return Error{path + ": " + sound.error().message};
  }
  cv::Mat image;
  try {
    image = cv::imdecode(png, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {  // reported below
  }
  if (image.type() != CV_16UC1 || image.cols != width || image.rows != height) {
    return Error{path + ": is a damaged PNG image"};
  }
  return std::vector<uint16_t>(image.begin<uint16_t>(), image.end<uint16_t>());
}

/// Numbers the labels that occur from 1 on, in their order; returns them.
std::vector<uint16_t> Renumber(std::vector<uint16_t>& labels) {
  std::map<uint16_t, uint16_t> numbers;
  for (uint16_t label : labels) numbers.emplace(label, uint16_t{0});
  numbers.erase(0);
  std::vector<uint16_t> names;
  for (auto& [label, number] : numbers) {
    names.push_back(label);
    number = static_cast<uint16_t>(names.size());
  }
  for (uint16_t& label : labels) {
    if (label != 0) label = numbers.at(label);
  }
  return names;
}

}  // namespace

Result<LabelledScene> ReadLabelledScene(const Cloud& cloud, const std::string& path,
                                        const std::optional<Plane>& table_C) {
  if (!cloud.organised()) {
    return Error{"the cloud is not organised; --labels goes with one that has rows and columns"};
  }
  const auto intrinsics = EstimateIntrinsics(cloud);
  if (!intrinsics) return intrinsics.error();
  auto image = ToImage(cloud, &*intrinsics);
  if (!image) return image.error();
  if (image->width != cloud.width || image->height != cloud.height) {
    return Error{"the cloud is " + std::to_string(cloud.width) + "x" +
                 std::to_string(cloud.height) + ", larger than an image may be"};
  }
  auto labels = ReadLabels(path, image->width, image->height);
  if (!labels) return labels.error();
  const std::vector<uint16_t> names = Renumber(*labels);
  if (names.empty()) return Error{path + ": labels no pixel; 0 is background, k object k"};

  LabelledScene scene;
  const auto table = table_C ? Result<Plane>(*table_C) : FindTablePlane(*image, *labels);
  if (!table) return table.error();
  scene.table_C = *table;
  auto rims = FindRims(*image, *labels, static_cast<int>(names.size()), scene.table_C);
  for (size_t k = 0; k < names.size(); ++k) {
    scene.objects.push_back({names[k], {}, std::move(rims[k])});
  }
  for (int v = 0; v < image->height; ++v) {
    for (int u = 0; u < image->width; ++u) {
      const uint16_t label = (*labels)[image->Index(u, v)];
      if (label == 0 || !image->HasDepth(u, v)) continue;
      scene.objects[label - 1u].points_C.push_back(image->Point(u, v).cast<float>());
    }
  }
  scene.image = std::move(*image);
  return scene;
}

}  // namespace beckon::pose
