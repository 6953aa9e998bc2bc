// FRAME: compressed images under a checksum.
#include <zlib.h>

#include <beckon/frame_t.hpp>

#include "lcmtypes/codec.h"
#include "lcmtypes/codec/message.h"
#include "lcmtypes/codec/parts.h"

namespace beckon {
namespace codec {

constexpr int kMaxSide = 4096;
constexpr int32_t kMaxImageBytes = 64 << 20;
constexpr size_t kMaxFrameBytes = 2 * static_cast<size_t>(kMaxImageBytes) + 4096;
constexpr size_t kFingerprint = 8, kCrc = 4;

static void Walk(Walker& w, const frame_t*) {
  w.Skip(8 + 8);
  w.String("source", kMaxText);
  w.Skip(4 + 4 + 4 * 8 + 1 + 8);
  w.Skip(static_cast<size_t>(w.Count("depth_size", kMaxImageBytes)));
  w.Skip(1);
  w.Skip(static_cast<size_t>(w.Count("colour_size", kMaxImageBytes)));
  w.Skip(kCrc);
}

static Status Check(const msg::Frame& frame) {
  return Rules("frame")
      .Time(frame.utime)
      .Require(frame.seq >= 1, "seq is below 1")
      .Text(frame.source, "source")
      .Range(frame.width, "width", 1, kMaxSide)
      .Range(frame.height, "height", 1, kMaxSide)
      .Require(Validate(frame.intrinsics))
      .Require(frame.depth_codec == msg::DepthCodec::kPng, "depth_codec is unknown")
      .Range(frame.depth_unit_m, "depth_unit_m", 1e-6, 1)
      .Count(frame.depth.size(), "depth", kMaxImageBytes, 1)
      .Range(static_cast<int>(frame.colour_codec), "colour_codec", 0, 2)
      .Count(frame.colour.size(), "colour", kMaxImageBytes)
      .Require((frame.colour_codec == msg::ColourCodec::kNone) == frame.colour.empty(),
               "colour_codec and colour disagree on whether there is colour");
}

static frame_t ToWire(const msg::Frame& frame) {
  frame_t wire{};
  wire.utime = frame.utime;
  wire.seq = frame.seq;
  wire.source = frame.source;
  wire.width = frame.width;
  wire.height = frame.height;
  wire.fx = frame.intrinsics.fx;
  wire.fy = frame.intrinsics.fy;
  wire.cx = frame.intrinsics.cx;
  wire.cy = frame.intrinsics.cy;
  wire.depth_codec = static_cast<int8_t>(frame.depth_codec);
  wire.depth_unit_m = frame.depth_unit_m;
  wire.depth_size = static_cast<int32_t>(frame.depth.size());
  wire.depth = frame.depth;
  wire.colour_codec = static_cast<int8_t>(frame.colour_codec);
  wire.colour_size = static_cast<int32_t>(frame.colour.size());
  wire.colour = frame.colour;
  return wire;
}

static Result<msg::Frame> FromWire(const frame_t& wire) {
  msg::Frame frame;
  frame.utime = wire.utime;
  frame.seq = wire.seq;
  frame.source = wire.source;
  frame.width = wire.width;
  frame.height = wire.height;
  frame.intrinsics = {.fx = wire.fx, .fy = wire.fy, .cx = wire.cx, .cy = wire.cy};
  frame.depth_codec = static_cast<msg::DepthCodec>(wire.depth_codec);
  frame.depth_unit_m = wire.depth_unit_m;
  frame.depth = wire.depth;
  frame.colour_codec = static_cast<msg::ColourCodec>(wire.colour_codec);
  frame.colour = wire.colour;
  return frame;
}

/// Over everything between fingerprint and checksum.
uint32_t Checksum(std::span<const uint8_t> bytes) {
  const auto covered = bytes.subspan(kFingerprint, bytes.size() - kFingerprint - kCrc);
  return static_cast<uint32_t>(crc32_z(0, covered.data(), covered.size()));
}

}  // namespace codec

Result<std::vector<uint8_t>> Codec<msg::Frame>::Encode(const msg::Frame& value) {
  auto bytes =
      codec::EncodeMessage<frame_t>(value, codec::Check, codec::ToWire, codec::kMaxFrameBytes);
  if (!bytes) return bytes;
  const uint32_t crc = codec::Checksum(*bytes);
  for (size_t i = 0; i < codec::kCrc; ++i)
    (*bytes)[bytes->size() - 1 - i] = static_cast<uint8_t>(crc >> (8 * i));
  return bytes;
}

Result<msg::Frame> Codec<msg::Frame>::Decode(std::span<const uint8_t> bytes) {
  if (bytes.size() < codec::kFingerprint + codec::kCrc) return Error{"frame_t: truncated"};
  uint32_t crc = 0;
  for (uint8_t byte : bytes.last(codec::kCrc)) crc = crc << 8 | byte;
  if (crc != codec::Checksum(bytes))
    return Error{"frame_t: checksum differs, the frame was damaged on its way"};
  return codec::DecodeMessage<frame_t, msg::Frame>(bytes, codec::Walk, codec::FromWire,
                                                   codec::Check);
}

}  // namespace beckon
