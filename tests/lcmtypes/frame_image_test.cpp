#include "lcmtypes/frame_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "tests/lcmtypes/largest_image.h"

namespace beckon {
namespace {

RgbdImage Gradient(int width, int height) {
  RgbdImage image{.width = width, .height = height, .intrinsics = {}, .depth_m = {}, .colour = {}};
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      image.depth_m.push_back((u + v) % 5 == 0 ? 0.f : 0.6f + 0.001f * static_cast<float>(u));
      image.colour.push_back({200, static_cast<uint8_t>(u), static_cast<uint8_t>(v)});
    }
  }
  return image;
}

TEST(FrameImage, DepthIsLosslessInItsUnitAndColourIsClose) {
  const RgbdImage image = Gradient(64, 48);
  msg::Frame frame;
  ASSERT_TRUE(EncodeImage(image, 1e-4, 95, frame).ok());
  const auto back = DecodeImage(frame);
  ASSERT_TRUE(back.ok()) << back.error().message;
  for (size_t i = 0; i < image.depth_m.size(); ++i) {
    EXPECT_NEAR(back->depth_m[i], image.depth_m[i], 0.51e-4);
    EXPECT_EQ(back->depth_m[i] == 0, image.depth_m[i] == 0);
    EXPECT_NEAR(back->colour[i][0], image.colour[i][0], 25) << "red stays red";
  }
}

TEST(FrameImage, WorksWithoutColour) {
  RgbdImage image = Gradient(16, 16);
  image.colour.clear();
  msg::Frame frame;
  ASSERT_TRUE(EncodeImage(image, 1e-4, 90, frame).ok());
  const auto back = DecodeImage(frame);
  ASSERT_TRUE(back.ok());
  EXPECT_TRUE(back->colour.empty());
}

TEST(FrameImage, RefusesDamagedAndMislabelledImages) {
  msg::Frame frame;
  ASSERT_TRUE(EncodeImage(Gradient(32, 32), 1e-4, 90, frame).ok());
  msg::Frame truncated = frame;
  truncated.depth.resize(20);
  EXPECT_FALSE(DecodeImage(truncated).ok());
  msg::Frame text = frame;
  text.colour.assign(100, 'x');
  EXPECT_FALSE(DecodeImage(text).ok());
  msg::Frame resized = frame;
  resized.width = 16;
  EXPECT_FALSE(DecodeImage(resized).ok());
  msg::Frame swapped = frame;
  std::swap(swapped.depth, swapped.colour);
  EXPECT_FALSE(DecodeImage(swapped).ok());
}

// A small file may claim a huge image; it is refused before memory is taken for it.
TEST(FrameImage, RefusesImagesThatClaimAnotherSizeBeforeDecodingThem) {
  msg::Frame frame;
  ASSERT_TRUE(EncodeImage(Gradient(32, 32), 1e-4, 90, frame).ok());
  msg::Frame huge_png = frame;
  for (int i = 16; i < 24; ++i) huge_png.depth[i] = i % 4 == 2 ? 0x75 : 0;  // 30,000 squared
  EXPECT_FALSE(DecodeImage(huge_png).ok());
  msg::Frame huge_jpeg = frame;
  for (size_t i = 2; i + 9 < huge_jpeg.colour.size(); ++i) {
    if (huge_jpeg.colour[i] == 0xff && huge_jpeg.colour[i + 1] == 0xc0) {
      for (int k = 5; k < 9; ++k) huge_jpeg.colour[i + k] = 0x75;
      break;
    }
  }
  EXPECT_FALSE(DecodeImage(huge_jpeg).ok());
}

using Bytes = std::vector<uint8_t>;

void Insert(const Bytes& what, size_t at, Bytes& bytes) {
  bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), what.begin(), what.end());
}

/// A PNG's chunk with its checksum.
Bytes Chunk(const std::string& type, const Bytes& data) {
  Bytes chunk(type.begin(), type.end());
  chunk.insert(chunk.end(), data.begin(), data.end());
  const auto crc = static_cast<uint32_t>(crc32_z(0, chunk.data(), chunk.size()));
  for (int shift : {24, 16, 8, 0}) chunk.push_back(static_cast<uint8_t>(crc >> shift));
  Insert({0, 0, 0, static_cast<uint8_t>(data.size())}, 0, chunk);
  return chunk;
}

// What is in front of the header must not pass for it.
TEST(FrameImage, RefusesAPngThatHidesItsSizeBehindAnotherChunk) {
  msg::Frame frame;
  ASSERT_TRUE(EncodeImage(Gradient(32, 32), 1e-4, 90, frame).ok());
  const Bytes told(frame.depth.begin() + 16, frame.depth.begin() + 29);
  Bytes large = told;
  large[2] = large[6] = 0x20;  // 8224 squared
  frame.depth.erase(frame.depth.begin() + 8, frame.depth.begin() + 33);
  Insert(Chunk("IHDR", large), 8, frame.depth);
  Insert(Chunk("fuZz", told), 8, frame.depth);
  const LargestImage largest;
  EXPECT_FALSE(DecodeImage(frame).ok());
  EXPECT_LT(largest.bytes(), 1u << 16);
}

// Bytes of 0xff in front of a marker are none of its segment; one who counts them as such looks for
// the size elsewhere.
TEST(FrameImage, RefusesAJpegThatHidesItsSizeBehindFillBytes) {
  msg::Frame frame;
  ASSERT_TRUE(EncodeImage(Gradient(32, 32), 1e-4, 90, frame).ok());
  const Bytes start_of_frame{0xff, 0xc0};
  const auto told = std::search(frame.colour.begin(), frame.colour.end(), start_of_frame.begin(),
                                start_of_frame.end());
  ASSERT_NE(told, frame.colour.end());
  const Bytes decoy(told, told + 19);
  told[5] = told[7] = 0x20;  // about 8200 squared
  Insert({0xff}, 2, frame.colour);
  const size_t at = 4 + (static_cast<size_t>(frame.colour[4]) << 8 | frame.colour[5]);
  ASSERT_GT(at, frame.colour.size());
  frame.colour.resize(at);
  Insert(decoy, at, frame.colour);
  const LargestImage largest;
  EXPECT_FALSE(DecodeImage(frame).ok());
  EXPECT_LT(largest.bytes(), 1u << 16);
}

// Each scan of a JPEG costs a pass over the whole image, however few bytes it has.
TEST(FrameImage, RefusesAJpegOfScansWithoutEnd) {
  const RgbdImage image = Gradient(32, 32);
  msg::Frame frame;
  ASSERT_TRUE(EncodeImage(image, 1e-4, 90, frame).ok());
  const cv::Mat bgr(32, 32, CV_8UC3, const_cast<Rgb*>(image.colour.data()));
  cv::imencode(".jpg", bgr, frame.colour, {cv::IMWRITE_JPEG_PROGRESSIVE, 1});
  EXPECT_TRUE(DecodeImage(frame).ok());
  const Bytes start_of_scan{0xff, 0xda};
  const auto last = std::find_end(frame.colour.begin(), frame.colour.end(), start_of_scan.begin(),
                                  start_of_scan.end());
  const Bytes scan(last, frame.colour.end() - 2);
  for (int i = 0; i < 200; ++i) Insert(scan, frame.colour.size() - 2, frame.colour);
  const auto refused = DecodeImage(frame);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, testing::HasSubstr("scans"));
}

TEST(FrameImage, RefusesImagesWhoseSizesDisagree) {
  RgbdImage image = Gradient(8, 8);
  image.depth_m.pop_back();
  msg::Frame frame;
  EXPECT_FALSE(EncodeImage(image, 1e-4, 90, frame).ok());
}

}  // namespace
}  // namespace beckon
