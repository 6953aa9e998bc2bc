// What fuzzing feeds the reader of FRAME messages: bytes that choose a frame and what damages it.
#include "tests/lcmtypes/frame_fuzz.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "lcmtypes/codec.h"
#include "lcmtypes/frame_image.h"
#include "tests/draws.h"
#include "tests/lcmtypes/largest_image.h"

namespace beckon {
namespace {

using Bytes = std::vector<uint8_t>;

/// What an image takes that is as large as `frame` says, as 16-bit depth with alpha and all.
size_t MostBytes(const msg::Frame& frame) {
  return 8 * static_cast<size_t>(frame.width) * static_cast<size_t>(frame.height) + 4096;
}

void WriteBigEndian32(Bytes& bytes, size_t at, uint32_t value) {
  for (size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<uint8_t>(value >> (24 - 8 * i));
}

uint32_t BigEndian32(const Bytes& bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value = value << 8 | bytes[at + i];
  return value;
}

msg::Frame SoundFrame(Draws& draws) {
  RgbdImage image;
  image.width = draws.Between(1, 48);
  image.height = draws.Between(1, 48);
  const size_t pixels = static_cast<size_t>(image.width) * image.height;
  const int colour = draws.Between(0, 3);
  for (size_t i = 0; i < pixels; ++i) {
    image.depth_m.push_back(i % 7 == 0 ? 0.0f : 0.5f + 0.001f * static_cast<float>(i % 900));
    if (colour > 0) image.colour.push_back({static_cast<uint8_t>(i), 90, 200});
  }
  msg::Frame frame{.utime = 1, .seq = 1, .source = "fuzz"};
  (void)EncodeImage(image, 1e-4, 90, frame);
  if (colour > 1) {
    const cv::Mat bgr(image.height, image.width, CV_8UC3, image.colour.data());
    if (colour == 2) {
      cv::imencode(".png", bgr, frame.colour);
      frame.colour_codec = msg::ColourCodec::kPng;
    } else {
      cv::imencode(".jpg", bgr, frame.colour, {cv::IMWRITE_JPEG_PROGRESSIVE, 1});
    }
  }
  return frame;
}

/// Bits flipped, bytes overwritten, a piece cut out, doubled or moved, an end cut off.
void Damage(Bytes& bytes, Draws& draws) {
  for (size_t n = draws.Index(6); n > 0 && !bytes.empty(); --n) {
    const size_t at = draws.Index(bytes.size());
    const size_t length = std::min(1 + draws.Index(24), bytes.size() - at);
    const auto piece = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    const auto end = piece + static_cast<std::ptrdiff_t>(length);
    switch (draws.Index(7)) {
      case 0:
        bytes[at] ^= static_cast<uint8_t>(1 << draws.Index(8));
        break;
      case 1:
        std::fill(piece, end, draws.OneIn(2) ? 0xff : static_cast<uint8_t>(draws()));
        break;
      case 2:
        bytes.erase(piece, end);
        break;
      case 3: {
        const Bytes copy(piece, end);
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(draws.Index(bytes.size())),
                     copy.begin(), copy.end());
        break;
      }
      case 4:
        bytes.resize(at);
        break;
      case 5:
        if (length >= 4) WriteBigEndian32(bytes, at, draws());
        break;
      default:
        bytes.insert(piece, length, 0xff);
    }
  }
}

/// Claims another size where a PNG has it, or where a JPEG would.
void ClaimAnotherSize(Bytes& image, Draws& draws) {
  if (image.size() < 24) return;
  if (image[0] == 0x89) return WriteBigEndian32(image, draws.OneIn(2) ? 16 : 20, draws() >> 14);
  for (size_t i = 0; i + 9 < image.size(); ++i) {
    if (image[i] != 0xff || (image[i + 1] != 0xc0 && image[i + 1] != 0xc2)) continue;
    image[i + 5 + draws.Index(4)] = static_cast<uint8_t>(draws());
  }
}

/// Makes the checksums of a PNG's chunks right, as far as there are whole ones.
void SealPng(Bytes& image) {
  if (image.empty() || image[0] != 0x89) return;
  for (size_t at = 8; at + 12 <= image.size();) {
    const size_t length = BigEndian32(image, at);
    if (length > image.size() - at - 12) return;
    WriteBigEndian32(image, at + 8 + length,
                     static_cast<uint32_t>(crc32_z(0, &image[at + 4], length + 4)));
    at += length + 12;
  }
}

void DamageImage(Bytes& image, Draws& draws) {
  if (draws.OneIn(4)) ClaimAnotherSize(image, draws);
  if (draws.OneIn(2)) Damage(image, draws);
  if (!draws.OneIn(4)) SealPng(image);
}

/// What the frame says of its images is no longer so.
void Lie(msg::Frame& frame, Draws& draws) {
  switch (draws.Index(6)) {
    case 0:
      frame.width = draws.Between(0, 300);
      break;
    case 1:
      frame.height = draws.Between(-1, 5000);
      break;
    case 2:
      std::swap(frame.depth, frame.colour);
      break;
    case 3:
      frame.colour = frame.depth;
      break;
    case 4:
      frame.colour_codec = static_cast<msg::ColourCodec>(draws.Between(0, 3));
      break;
    default:
      frame.intrinsics.fx = static_cast<double>(draws.OddNumber());
  }
}

/// Makes the frame's checksum right.
void SealFrame(Bytes& bytes) {
  if (bytes.size() < 12) return;
  WriteBigEndian32(bytes, bytes.size() - 4,
                   static_cast<uint32_t>(crc32_z(0, &bytes[8], bytes.size() - 12)));
}

std::string Unsound(const RgbdImage& image, const msg::Frame& frame) {
  const size_t pixels = static_cast<size_t>(frame.width) * static_cast<size_t>(frame.height);
  if (image.width != frame.width || image.height != frame.height) return "another size";
  if (image.depth_m.size() != pixels) return "not a depth for each pixel";
  const bool has_colour = frame.colour_codec != msg::ColourCodec::kNone;
  if (image.colour.size() != (has_colour ? pixels : 0)) return "not a colour for each pixel";
  for (float depth_m : image.depth_m) {
    if (!(std::isfinite(depth_m) && depth_m >= 0)) return "depth that is no depth";
  }
  return "";
}

}  // namespace

std::string FuzzFrame(std::span<const uint8_t> bytes) {
  Draws draws(bytes);
  msg::Frame frame = SoundFrame(draws);
  if (draws.OneIn(2)) DamageImage(frame.depth, draws);
  if (draws.OneIn(2)) DamageImage(frame.colour, draws);
  if (draws.OneIn(4)) Lie(frame, draws);
  auto encoded = Codec<msg::Frame>::Encode(frame);
  if (!encoded) return encoded.error().message.empty() ? "not encoded, and not why" : "";
  if (draws.OneIn(3)) Damage(*encoded, draws);
  if (!draws.OneIn(8)) SealFrame(*encoded);
  const auto decoded = Codec<msg::Frame>::Decode(*encoded);
  if (!decoded) return decoded.error().message.empty() ? "not decoded, and not why" : "";
  const LargestImage largest;
  const auto image = DecodeImage(*decoded);
  if (largest.bytes() > MostBytes(*decoded)) {
    return "an image of " + std::to_string(largest.bytes()) + " bytes was made room for";
  }
  if (!image) return image.error().message.empty() ? "no image, and not why" : "";
  return Unsound(*image, *decoded);
}

}  // namespace beckon
