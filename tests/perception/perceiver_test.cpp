// Objects are categorised anew only where that may change something.
#include "services/perception/perceiver.h"

#include <gtest/gtest.h>

#include "tests/perception/box_world.h"

namespace beckon::perception {
namespace {

/// A perceiver that counts how many views were categorised.
struct CountingPerceiver {
  std::atomic<int> calls = 0;
  Perceiver perceiver;
  explicit CountingPerceiver(int threads = 1, SegmentationMethod method = SegmentationMethod::kFast)
      : perceiver({.segmentation = {.method = method}, .threads = threads},
                  [this](const ObjectView& view) {
                    ++calls;
                    Categorisation c;
                    c.probabilities = {{"Box", 0.75f}, {"Can", 0.25f}};
                    c.confidence = static_cast<float>(view.pixels.size() % 100) / 100;
                    c.ask_user = false;
                    return c;
                  }) {}
};

TEST(Perceiver, CategorisesAnObjectOnceWhileItsViewStays) {
  CountingPerceiver counting;
  const RgbdImage image = ThreeBoxes().Render();
  const Perception first = counting.perceiver.Perceive(image);
  EXPECT_EQ(counting.calls, 3);
  const Perception second = counting.perceiver.Perceive(image);
  EXPECT_EQ(counting.calls, 3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(second.objects[i].id, first.objects[i].id);
    EXPECT_TRUE(second.objects[i].categorised);
    EXPECT_EQ(second.objects[i].category.confidence, first.objects[i].category.confidence);
  }
}

TEST(Perceiver, LooksAnewAtTheObjectThatMoved) {
  CountingPerceiver counting;
  BoxWorld world = ThreeBoxes();
  counting.perceiver.Perceive(world.Render());
  world.boxes[1].low.x() += 0.02;
  world.boxes[1].high.x() += 0.02;
  const Perception moved = counting.perceiver.Perceive(world.Render());
  EXPECT_EQ(counting.calls, 4);
  ASSERT_EQ(moved.objects.size(), 3u);
  for (const auto& object : moved.objects) EXPECT_LE(object.id, 3);
}

TEST(Perceiver, NoisyFramesOfTheSameViewAreNotCategorisedAgain) {
  CountingPerceiver counting;
  BoxWorld world = ThreeBoxes();
  world.noise_m = kKinectNoise_m;
  for (unsigned seed = 1; seed <= 12; ++seed)
    counting.perceiver.Perceive(world.Render(nullptr, seed));
  EXPECT_EQ(counting.calls, 3);
}

TEST(Perceiver, WhatComesBackToWhereItWasIsNotCategorisedAgain) {
  CountingPerceiver counting;
  BoxWorld world = ThreeBoxes();
  for (const double step_m : {0.0, 0.02, -0.02, 0.02, -0.02}) {
    world.boxes[1].low.x() += step_m;
    world.boxes[1].high.x() += step_m;
    counting.perceiver.Perceive(world.Render());
  }
  EXPECT_EQ(counting.calls, 4);
}

TEST(Perceiver, KeepsOnlyAFewViewsOfAnObjectThatTheUserNamed) {
  CountingPerceiver counting;
  BoxWorld world = ThreeBoxes();
  const int id = counting.perceiver.Perceive(world.Render()).objects[0].id;
  ASSERT_TRUE(counting.perceiver.Tell(id, {"l", "Tin"}));
  int kept = 0;
  for (int step = 0; step < 10; ++step) {
    for (int box = 1; box <= 3; ++box) {
      world.boxes[box].low.x() += 0.015;
      world.boxes[box].high.x() += 0.015;
    }
    const Perception perception = counting.perceiver.Perceive(world.Render());
    for (const auto& object : perception.objects) {
      EXPECT_EQ(object.category.probabilities.front().first, object.id == id ? "Tin" : "Box");
      EXPECT_TRUE(object.id == id || !object.is_example);
      kept += object.is_example ? 1 : 0;
    }
  }
  EXPECT_EQ(kept, PerceiverConfig().views_per_object);
  EXPECT_FALSE(counting.perceiver.Tell(99, {"l", "Tin"})) << "nobody knows this object";
}

TEST(Perceiver, KnowsANamedObjectUnderANewIdByItsLook) {
  Perceiver perceiver({.tracker = {.forget_after_frames = 2}}, [](const ObjectView&) {
    Categorisation unsure;
    unsure.probabilities = {{"Box", 0.6f}, {"Tin", 0.4f}};
    return unsure;
  });
  BoxWorld world = ThreeBoxes();
  world.boxes[1].colour = {220, 30, 30};
  const WorldBox red = world.boxes[1];
  const auto is_red = [&](const PerceivedObject& object) {
    return std::abs(object.shape.centroid_W.x() - (red.low.x() + red.high.x()) / 2) < 0.05;
  };
  const Perception first = perceiver.Perceive(world.Render());
  const auto named = std::ranges::find_if(first.objects, is_red);
  ASSERT_NE(named, first.objects.end());
  ASSERT_TRUE(perceiver.Tell(named->id, {"l", "Tin"}));
  perceiver.Perceive(world.Render());

  world.boxes.erase(world.boxes.begin() + 1);
  for (int frame = 0; frame < 60; ++frame) perceiver.Perceive(world.Render());
  world.boxes.insert(world.boxes.begin() + 1, red);
  Perception back;
  for (int frame = 0; frame < 30; ++frame) back = perceiver.Perceive(world.Render());
  ASSERT_EQ(back.objects.size(), 3u);
  for (const PerceivedObject& object : back.objects) {
    if (is_red(object)) {
      EXPECT_GT(object.id, 3) << "a new id";
    }
    EXPECT_FALSE(object.told) << "recognised, not told";
    EXPECT_EQ(object.category.probabilities.front().first, is_red(object) ? "Tin" : "Box");
    EXPECT_EQ(object.category.ask_user, !is_red(object));
  }
}

TEST(Perceiver, LooksAnewAtTheObjectThatChanged) {
  // 6 cm tall before, of which the reference sees the upper 5: its centroid stays within a
  // centimetre.
  for (const auto& [method, growth_m] :
       {std::pair(SegmentationMethod::kReference, 0.015), {SegmentationMethod::kFast, 0.02}}) {
    CountingPerceiver counting(1, method);
    BoxWorld world = ThreeBoxes();
    counting.perceiver.Perceive(world.Render());
    world.boxes[3].high.z() += growth_m;
    counting.perceiver.Perceive(world.Render());
    EXPECT_EQ(counting.calls, 4) << Name(method);
  }
}

TEST(Perceiver, ThreadsChangeNothing) {
  CountingPerceiver one(1), four(4);
  const RgbdImage image = ThreeBoxes().Render();
  const Perception a = one.perceiver.Perceive(image), b = four.perceiver.Perceive(image);
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (size_t i = 0; i < a.objects.size(); ++i) {
    EXPECT_EQ(a.objects[i].category.confidence, b.objects[i].category.confidence);
  }
}

TEST(Perceiver, AFaultInAThreadComesOutAsAnException) {
  Perceiver perceiver({.threads = 3}, [](const ObjectView&) -> Categorisation {
    throw std::runtime_error("broken");
  });
  EXPECT_THROW(perceiver.Perceive(ThreeBoxes().Render()), std::runtime_error);
}

TEST(Perceiver, WithoutACategoriserObjectsAreUnknownAndToBeAskedAbout) {
  Perceiver perceiver({}, nullptr);
  const Perception perception = perceiver.Perceive(ThreeBoxes().Render());
  ASSERT_EQ(perception.objects.size(), 3u);
  for (const auto& object : perception.objects) {
    EXPECT_FALSE(object.categorised);
    EXPECT_TRUE(object.category.ask_user);
  }
}

}  // namespace
}  // namespace beckon::perception
