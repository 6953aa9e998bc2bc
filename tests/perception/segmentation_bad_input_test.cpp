// What the fast segmentation makes of bad input.
#include "services/perception/segmentation_fast.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <random>
#include <vector>

#include "services/perception/perceiver.h"
#include "tests/perception/box_world.h"

namespace beckon::perception {
namespace {

/// ThreeBoxes as a Kinect sees them.
BoxWorld NoisyBoxes() {
  BoxWorld world = ThreeBoxes();
  world.width = 640;
  world.height = 480;
  world.noise_m = kKinectNoise_m;
  return world;
}

RgbdImage Turned(RgbdImage image) {  // by half a turn
  std::reverse(image.depth_m.begin(), image.depth_m.end());
  std::reverse(image.colour.begin(), image.colour.end());
  return image;
}

TEST(SegmentFast, SaysWhyThereIsNoTable) {
  BoxWorld wall;
  wall.pitch_deg = 5;
  wall.boxes = {{{-3, 1.5, -1}, {3, 1.6, 3}}};
  BoxWorld down = ThreeBoxes();
  down.pitch_deg = 89.9;
  down.boxes[0] = {{-1, -1, -0.03}, {1, 1.3, 0}};
  RgbdImage noise = ThreeBoxes().Render();
  std::mt19937 engine(1);
  for (float& depth_m : noise.depth_m) {
    depth_m = 0.5f + static_cast<float>(engine() % 2000) / 1000;
  }
  RgbdImage none = noise;
  std::fill(none.depth_m.begin(), none.depth_m.end(), 0.0f);
  for (const auto& [image, words] :
       {std::pair(wall.Render(), "tilted"), std::pair(down.Render(), "tilted"),
        std::pair(Turned(ThreeBoxes().Render()), "tilted"), std::pair(noise, "no plane"),
        std::pair(none, "only 0 pixels")}) {
    const Segmentation result = SegmentFast(image, {});
    EXPECT_FALSE(result.table_C);
    EXPECT_THAT(result.reason, testing::HasSubstr(words));
    EXPECT_EQ(result.n_objects, 0);
    EXPECT_EQ(std::count(result.labels.begin(), result.labels.end(), 0),
              static_cast<std::ptrdiff_t>(image.depth_m.size()));
  }
}

TEST(SegmentFast, BearsHalfTheDepthMissing) {
  const RgbdImage image = NoisyBoxes().Render();
  RgbdImage columns = image, scattered = image;
  std::mt19937 engine(5);
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      if (u < image.width / 2) columns.depth_m[image.Index(u, v)] = 0;
      if (engine() % 2 == 0) scattered.depth_m[image.Index(u, v)] = 0;
    }
  }
  EXPECT_TRUE(SegmentFast(columns, {}).table_C);
  const Segmentation result = SegmentFast(scattered, {});
  EXPECT_TRUE(result.table_C);
  EXPECT_EQ(result.n_objects, 3);
}

TEST(SegmentFast, SpecklesAreNoObjects) {
  RgbdImage image = NoisyBoxes().Render();
  std::mt19937 engine(7);
  for (int i = 0; i < 3000; ++i) {
    image.depth_m[engine() % image.depth_m.size()] =
        0.4f + static_cast<float>(engine() % 1000) / 1000;
  }
  const Segmentation result = SegmentFast(image, {});
  EXPECT_TRUE(result.table_C);
  EXPECT_EQ(result.n_objects, 3);
}

TEST(SegmentFast, SeesATableFourMetresAway) {
  BoxWorld world;
  world.width = 640;
  world.height = 480;
  world.camera_height_m = 1.6;
  world.pitch_deg = 22;
  world.noise_m = 0.0019;
  world.boxes = {{{-1, 2.9, -0.03}, {1, 4.4, 0}}, At(0, 3.5, 0, 0.4, 0.3, 0.4)};
  SegmentationConfig config;
  EXPECT_FALSE(SegmentFast(world.Render(), config).reason.empty());
  config.max_range_m = 5;
  const Segmentation result = SegmentFast(world.Render(), config);
  ASSERT_TRUE(result.table_C) << result.reason;
  EXPECT_EQ(result.n_objects, 1);
}

TEST(SegmentFast, FramesMayChangeTheirSize) {
  Perceiver perceiver({}, nullptr);
  for (int width : {640, 320, 64, 641, 1, 640}) {
    BoxWorld world = ThreeBoxes();
    world.width = width;
    world.height = width * 3 / 4;
    const Perception perception = perceiver.Perceive(world.Render());
    EXPECT_EQ(perception.segmentation.table_C.has_value(), width >= 320) << width;
    if (width >= 320) {
      EXPECT_EQ(perception.objects.size(), 3u) << width;
    }
  }
}

TEST(SegmentFast, AnImageNarrowerThanACellHasNoTable) {
  for (const auto& [width, height] : {std::pair(1, 480), std::pair(640, 1), std::pair(1, 1)}) {
    RgbdImage image{width, height, {}, {}, {}};  // a cell is two pixels wide
    image.depth_m.assign(static_cast<size_t>(width) * height, 1);
    const Segmentation result = SegmentFast(image, {});
    EXPECT_FALSE(result.table_C);
    EXPECT_FALSE(result.reason.empty());
    EXPECT_EQ(result.labels, std::vector<uint16_t>(image.depth_m.size(), 0));
  }
}

/// Corrupt depth: blocks and pixels of holes, NaN, infinities, negative and huge values, noise.
RgbdImage Corrupted(const RgbdImage& image, unsigned seed) {
  RgbdImage bad = image;
  std::mt19937 engine(seed);
  const float values[] = {0,
                          std::numeric_limits<float>::quiet_NaN(),
                          std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity(),
                          -1,
                          1e30f,
                          1e-30f,
                          std::numeric_limits<float>::denorm_min(),
                          2.9999f,
                          0.3f};
  const unsigned n_blocks = engine() % 40;
  for (unsigned b = 0; b < n_blocks; ++b) {
    const int left = static_cast<int>(engine() % image.width),
              top = static_cast<int>(engine() % image.height);
    const int right = std::min<int>(image.width, left + 1 + static_cast<int>(engine() % 120));
    const int bottom = std::min<int>(image.height, top + 1 + static_cast<int>(engine() % 90));
    const float value = values[engine() % std::size(values)];
    const bool noise = engine() % 3 == 0;
    for (int v = top; v < bottom; ++v) {
      for (int u = left; u < right; ++u) {
        bad.depth_m[image.Index(u, v)] =
            noise ? 0.3f + static_cast<float>(engine() % 3000) / 1000 : value;
      }
    }
  }
  const unsigned n_pixels = engine() % 20000;
  for (unsigned i = 0; i < n_pixels; ++i) {
    bad.depth_m[engine() % bad.depth_m.size()] = values[engine() % std::size(values)];
  }
  return bad;
}

TEST(SegmentFast, CorruptDepthGivesAStatedResult) {
  BoxWorld world = ThreeBoxes();
  world.noise_m = kKinectNoise_m;
  world.cups.push_back({{-0.05, 0.55}, 0.04, 0.09});
  const RgbdImage image = world.Render();
  for (unsigned seed = 0; seed < 200; ++seed) {
    const RgbdImage bad = Corrupted(image, seed);
    const Segmentation result = SegmentFast(bad, {});
    ASSERT_EQ(result.labels.size(), bad.depth_m.size());
    EXPECT_EQ(result.table_C.has_value(), result.reason.empty());
    for (size_t i = 0; i < bad.depth_m.size(); ++i) {
      ASSERT_LE(result.labels[i], result.n_objects);
      if (result.labels[i] != 0) {
        ASSERT_TRUE(bad.depth_m[i] > 0 && bad.depth_m[i] < 4) << bad.depth_m[i];
      }
    }
    if (result.table_C) {
      EXPECT_TRUE(result.table_C->normal.allFinite());
      EXPECT_TRUE(std::isfinite(result.table_C->offset_m));
    }
  }
}

/// Processor time of this thread for one segmentation, s.
double Seconds(const RgbdImage& image) {
  timespec start, end;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &start);
  SegmentFast(image, {});
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
  return static_cast<double>(end.tv_sec - start.tv_sec) +
         1e-9 * static_cast<double>(end.tv_nsec - start.tv_nsec);
}

/// The best time of each image. They take turns, so that a machine that is busy for a while slows
/// all of them, and each gets `rounds` chances to be undisturbed.
std::vector<double> BestSeconds(const std::vector<RgbdImage>& images, int rounds) {
  std::vector<double> best(images.size(), std::numeric_limits<double>::infinity());
  for (int i = 0; i < rounds; ++i) {
    for (size_t k = 0; k < images.size(); ++k) best[k] = std::min(best[k], Seconds(images[k]));
  }
  return best;
}

TEST(SegmentFast, NoFrameTakesMuchLongerThanAnother) {
  const RgbdImage image = NoisyBoxes().Render();
  RgbdImage rough = image;  // everything above the table, and rough
  std::mt19937 engine(11);
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      if ((u / 24 + v / 24) % 3 == 0) continue;
      rough.depth_m[image.Index(u, v)] -= 0.02f + 0.01f * static_cast<float>(engine() % 10);
    }
  }
  BoxWorld crowded = NoisyBoxes();
  for (int i = 0; i < 14; ++i) {
    for (int k = 0; k < 10; ++k) {
      crowded.boxes.push_back(
          At(-0.4 + 0.06 * i, 0.5 + 0.07 * k, 0, 0.05, 0.05, 0.03 + 0.01 * (i % 4)));
    }
  }
  const auto seconds = BestSeconds({image, rough, crowded.Render()}, 15);
  EXPECT_LT(seconds[1], 5 * seconds[0]) << "rough";
  EXPECT_LT(seconds[2], 5 * seconds[0]) << "crowded";
}

}  // namespace
}  // namespace beckon::perception
