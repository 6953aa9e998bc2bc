// What is told of the objects, and that it fits one datagram.
#include "services/perception/scene_message.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lcmtypes/codec.h"
#include "tests/perception/box_world.h"

namespace beckon::perception {
namespace {

double TwiceArea(const std::vector<std::array<int16_t, 2>>& p) {
  double sum = 0;
  for (size_t i = 0; i < p.size(); ++i) {
    const auto& a = p[i];
    const auto& b = p[(i + 1) % p.size()];
    sum += double(a[0]) * b[1] - double(b[0]) * a[1];
  }
  return sum;
}

TEST(SceneMessage, TellsWhereObjectsAre) {
  const BoxWorld world = ThreeBoxes();
  const RgbdImage image = world.Render();
  Perceiver perceiver({}, nullptr);
  const msg::Scene scene = MakeScene(image, perceiver.Perceive(image));
  ASSERT_TRUE(scene.has_table);
  // W of the message and of the world have the same axes; the table's top is z = 0 in both.
  EXPECT_LT((scene.X_WC.translation() - world.X_WC().translation()).norm(), 0.01);
  ASSERT_EQ(scene.objects.size(), 3u);
  for (const auto& object : scene.objects) {
    bool found = false;
    for (size_t b = 1; b < world.boxes.size(); ++b) {
      const Eigen::Vector3d low = world.boxes[b].low, high = world.boxes[b].high;
      if (!((object.centroid_W.array() > low.array() - 0.01).all() &&
            (object.centroid_W.array() < high.array() + 0.01).all())) {
        continue;
      }
      found = true;
      EXPECT_NEAR(object.extent_W.x(), (high - low).x(), 0.015);
      EXPECT_NEAR(object.extent_W.z(), (high - low).z() - 0.01, 0.015);
    }
    EXPECT_TRUE(found) << object.centroid_W.transpose();
    EXPECT_GT(object.n_points, 300);
    EXPECT_LE(object.points_C.size(), 600u);
    EXPECT_GT(object.points_C.size(), 150u);
    EXPECT_GE(object.outline_px.size(), 4u);
    EXPECT_LE(object.outline_px.size(), 64u);
    EXPECT_GT(TwiceArea(object.outline_px), 0) << "clockwise as seen";
    EXPECT_EQ(object.rim_C.size(), 96u);
    for (const auto& [u, v] : object.outline_px) {
      EXPECT_TRUE(u >= 0 && u < image.width && v >= 0 && v < image.height);
    }
  }
  double area = 0;
  for (size_t i = 0; i < scene.table_W.size(); ++i) {
    const auto& a = scene.table_W[i];
    const auto& b = scene.table_W[(i + 1) % scene.table_W.size()];
    area += (a.x() * b.y() - b.x() * a.y()) / 2;
  }
  EXPECT_GT(area, 0.3) << "counter-clockwise from above";
  EXPECT_LT(area, 1.3);
}

// One object that the message cannot hold must not cost the others their scene.
TEST(SceneMessage, LeavesOutWhatSpansMoreThanTheMessageCanSay) {
  RgbdImage image = ThreeBoxes().Render();
  Perceiver perceiver({}, nullptr);
  const Perception perception = perceiver.Perceive(image);
  ASSERT_EQ(perception.objects.size(), 3u);
  const auto& pixels = perception.objects[1].shape.pixels;
  for (size_t i = 0; i < pixels.size() / 2; ++i) image.depth_m[pixels[i]] += 4;
  msg::Scene scene = MakeScene(image, perception);
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[0].id, perception.objects[0].id);
  EXPECT_EQ(scene.objects[1].id, perception.objects[2].id);
  scene.utime = 1, scene.seq = 1, scene.frame_seq = 1, scene.source = "test";
  EXPECT_TRUE(Codec<msg::Scene>::Encode(scene));
}

TEST(SceneMessage, TellsSurelyUnknownObjectsWithoutAQuestion) {
  const RgbdImage image = ThreeBoxes().Render();
  Categorisation unknown;
  unknown.probabilities = {{msg::kUnknownCategory, 0.95F}, {"Box", 0.05F}};
  unknown.confidence = 0.9F;
  unknown.ask_user = false;
  Perceiver perceiver({}, [&](const ObjectView&) { return unknown; });
  msg::Scene scene = MakeScene(image, perceiver.Perceive(image));
  ASSERT_EQ(scene.objects.size(), 3u);
  for (const auto& object : scene.objects) {
    EXPECT_EQ(object.category, msg::kUnknownCategory);
    EXPECT_FALSE(object.ask_user);
  }
  scene.utime = 1, scene.seq = 1, scene.frame_seq = 1, scene.source = "test";
  EXPECT_TRUE(Codec<msg::Scene>::Encode(scene));
}

TEST(SceneMessage, WithoutATableIsValidToo) {
  RgbdImage image = ThreeBoxes().Render();
  image.depth_m.assign(image.depth_m.size(), 0);
  Perceiver perceiver({}, nullptr);
  msg::Scene scene = MakeScene(image, perceiver.Perceive(image));
  EXPECT_FALSE(scene.has_table);
  EXPECT_TRUE(scene.objects.empty());
  scene.utime = 1, scene.seq = 1, scene.frame_seq = 1, scene.source = "test";
  EXPECT_TRUE(Codec<msg::Scene>::Encode(scene));
}

/// The object whose visible points are around (x, y) of W.
const msg::SceneObject& ObjectAt(const msg::Scene& scene, double x, double y) {
  return *std::min_element(scene.objects.begin(), scene.objects.end(),
                           [&](const auto& a, const auto& b) {
                             const Eigen::Vector2d at(x, y);
                             return (a.centroid_W.template head<2>() - at).norm() <
                                    (b.centroid_W.template head<2>() - at).norm();
                           });
}

TEST(SceneMessage, TellsWhatLiesBeyondTheRims) {
  BoxWorld world;  // the left box hides a part of the right one, 2.5 cm behind it
  world.boxes = {Table(), Standing(-0.05, 0.6, 0.1, 0.05, 0.1),
                 Standing(0.02, 0.68, 0.12, 0.06, 0.15)};
  world.noise_m = 0.0015;
  const RgbdImage image = world.Render();
  Perceiver perceiver({}, nullptr);
  const msg::Scene scene = MakeScene(image, perceiver.Perceive(image));
  EXPECT_EQ(scene.intrinsics.fx, image.intrinsics.fx);
  EXPECT_EQ(scene.intrinsics.cy, image.intrinsics.cy);
  ASSERT_EQ(scene.objects.size(), 2u);
  const msg::SceneObject &front = ObjectAt(scene, -0.05, 0.6), &back = ObjectAt(scene, 0.02, 0.68);
  int hidden = 0;
  for (const RimPoint& rim : back.rim_C) hidden += rim.beyond == Beyond::kNearer;
  EXPECT_GT(hidden, 3) << "behind the other";
  for (const RimPoint& rim : front.rim_C) {
    const double height_m = (scene.X_WC * rim.point.cast<double>()).z();
    EXPECT_NE(rim.beyond, Beyond::kNearer);
    if (height_m > 0.04) {
      EXPECT_EQ(rim.beyond, Beyond::kFarther) << height_m;
    }
  }
}

/// 64 objects of 40 x 40 pixels, each with `n_categories` categories.
Perception Crowd(const RgbdImage& image, int n_categories) {
  Perception perception;
  perception.segmentation.table_C = Plane{{0, -0.7071067811865476, -0.7071067811865476}, 0.7};
  perception.X_WC = WorldFromTable(*perception.segmentation.table_C);
  for (int i = 0; i < 400; ++i) {
    const double a = i * 6.283185307 / 400;
    perception.segmentation.hull_C.emplace_back(std::cos(a), std::sin(a), 1);
  }
  perception.segmentation.labels.assign(image.depth_m.size(), 0);
  for (int k = 0; k < 64; ++k) {
    PerceivedObject object;
    object.id = 1'000'000 + k;
    object.categorised = true;
    for (int v = 0; v < 40; ++v) {
      for (int u = 0; u < 40; ++u) {
        object.shape.pixels.push_back(image.Index(k % 8 * 40 + u, k / 8 * 40 + v));
        perception.segmentation.labels[object.shape.pixels.back()] = static_cast<uint16_t>(k + 1);
      }
    }
    for (int c = 0; c < n_categories; ++c) {
      object.category.probabilities.emplace_back("Category number " + std::to_string(c),
                                                 1.0f / n_categories);
    }
    object.shape.outline_px.assign(kMaxOutline, {100, 100});
    perception.objects.push_back(object);
  }
  return perception;
}

TEST(SceneMessage, OfSixtyFourObjectsFitsOneDatagram) {
  RgbdImage image;
  image.width = 640;
  image.height = 480;
  image.depth_m.resize(640 * 480);
  for (size_t i = 0; i < image.depth_m.size(); ++i) {
    image.depth_m[i] = 0.8f + 0.0005f * static_cast<float>(i / 640);
  }
  for (int n_categories : {0, 11, 40}) {
    msg::Scene scene = MakeScene(image, Crowd(image, n_categories));
    scene.utime = 1, scene.seq = 1, scene.frame_seq = 1, scene.source = std::string(200, 'x');
    const auto bytes = Codec<msg::Scene>::Encode(scene);
    ASSERT_TRUE(bytes) << bytes.error().message;
    EXPECT_LE(bytes->size(), msg::kMaxDatagram);
    EXPECT_EQ(scene.objects.size(), 64u);
    for (const auto& object : scene.objects) {
      EXPECT_GE(object.points_C.size(), 20u);
      if (n_categories == 0) {
        EXPECT_GE(object.rim_C.size(), 16u);
      }
    }
  }
}

TEST(SampleSurface, StaysOnTheSurfaceAndWithinItsNumber) {
  const RgbdImage image = ThreeBoxes().Render();
  const Segmentation segmentation = Segment(image, {});
  const auto objects = ExtractObjects(image, segmentation, Pose::Identity(), segmentation.labels);
  ASSERT_EQ(objects.size(), 3u);
  for (int most : {0, 1, 10, 100, 600, 100000}) {
    const auto sample = SampleSurface(image, objects[0].pixels, most);
    EXPECT_LE(sample.size(), static_cast<size_t>(most));
    EXPECT_EQ(sample.empty(), most == 0);
    if (most < 100) continue;
    for (const auto& p : sample) {
      double nearest_m = 1;
      for (uint32_t i : objects[0].pixels) {
        nearest_m = std::min(
            nearest_m, (image.Point(i % image.width, i / image.width) - p.cast<double>()).norm());
      }
      EXPECT_LT(nearest_m, 0.012);
    }
  }
}

TEST(ExtractObjects, CentroidIsTheMeanOfTheVisiblePoints) {
  const RgbdImage image = ThreeBoxes().Render();
  const Segmentation segmentation = Segment(image, {});
  const Pose X_WC = WorldFromTable(*segmentation.table_C);
  size_t labelled = 0;
  for (const auto& object : ExtractObjects(image, segmentation, X_WC, segmentation.labels)) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (uint32_t i : object.pixels) sum += image.Point(i % image.width, i / image.width);
    EXPECT_LT((object.centroid_C - sum / object.pixels.size()).norm(), 1e-9);
    EXPECT_LT((object.centroid_W - X_WC * object.centroid_C).norm(), 1e-9);
    labelled += object.pixels.size();
  }
  EXPECT_EQ(labelled, image.depth_m.size() -
                          std::count(segmentation.labels.begin(), segmentation.labels.end(), 0));
}

}  // namespace
}  // namespace beckon::perception
