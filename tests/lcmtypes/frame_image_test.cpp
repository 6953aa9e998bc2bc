#include "lcmtypes/frame_image.h"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(FrameImage, RefusesImagesWhoseSizesDisagree) {
  RgbdImage image = Gradient(8, 8);
  image.depth_m.pop_back();
  msg::Frame frame;
  EXPECT_FALSE(EncodeImage(image, 1e-4, 90, frame).ok());
}

}  // namespace
}  // namespace beckon
