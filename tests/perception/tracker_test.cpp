// Objects keep their ids, and are categorised anew only where that may change something.
#include "services/perception/tracker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/perception/perceiver.h"
#include "tests/perception/box_world.h"

namespace beckon::perception {
namespace {

using testing::ElementsAre;

/// An object at (x, y, 1) in C that covers pixels first .. first + n.
ExtractedObject Object(double x, double y, uint32_t first, uint32_t n = 100) {
  ExtractedObject object;
  object.centroid_C = {x, y, 1};
  for (uint32_t i = 0; i < n; ++i) object.pixels.push_back(first + i);
  return object;
}

TEST(Tracker, KeepsIdsWhateverTheOrder) {
  Tracker tracker{{}};
  EXPECT_THAT(tracker.Update(std::vector{Object(0, 0, 0), Object(0.3, 0, 1000)}),
              ElementsAre(1, 2));
  EXPECT_THAT(tracker.Update(std::vector{Object(0.3, 0, 1000), Object(0, 0, 0)}),
              ElementsAre(2, 1));
}

TEST(Tracker, FollowsSmallStepsAndOverlap) {
  Tracker tracker{{}};
  tracker.Update(std::vector{Object(0, 0, 0)});
  EXPECT_THAT(tracker.Update(std::vector{Object(0.02, 0, 5000)}), ElementsAre(1));  // a small step
  EXPECT_THAT(tracker.Update(std::vector{Object(0.09, 0, 5010)}), ElementsAre(1));  // half hidden
  EXPECT_THAT(tracker.Update(std::vector{Object(0.2, 0, 9000)}), ElementsAre(2));   // elsewhere
}

TEST(Tracker, NeverGivesAnIdTwice) {
  Tracker tracker{{.forget_after_frames = 1}};
  EXPECT_THAT(tracker.Update(std::vector{Object(0, 0, 0)}), ElementsAre(1));
  tracker.Update({});
  tracker.Update({});
  EXPECT_FALSE(tracker.Remembers(1));
  EXPECT_THAT(tracker.Update(std::vector{Object(0, 0, 0)}), ElementsAre(2));
}

TEST(Tracker, AnObjectThatWasHiddenForAMomentComesBackAsItself) {
  Tracker tracker{{}};
  tracker.Update(std::vector{Object(0, 0, 0), Object(0.3, 0, 1000)});
  for (int i = 0; i < 50; ++i) tracker.Update(std::vector{Object(0.3, 0, 1000)});
  EXPECT_THAT(tracker.Update(std::vector{Object(0.3, 0, 1000), Object(0, 0, 0)}),
              ElementsAre(2, 1));
}

TEST(Tracker, TwoNearObjectsGoToTheNearestEach) {
  Tracker tracker{{}};
  tracker.Update(std::vector{Object(0, 0, 0), Object(0.025, 0, 1000)});
  EXPECT_THAT(tracker.Update(std::vector{Object(0.02, 0, 1000), Object(-0.01, 0, 0)}),
              ElementsAre(2, 1));
}

/// A perceiver that counts how many views were categorised.
struct CountingPerceiver {
  std::atomic<int> calls = 0;
  Perceiver perceiver;
  explicit CountingPerceiver(int threads = 1)
      : perceiver({.threads = threads}, [this](const ObjectView& view) {
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

TEST(Perceiver, LooksAnewAtTheObjectThatChanged) {
  CountingPerceiver counting;
  BoxWorld world = ThreeBoxes();
  counting.perceiver.Perceive(world.Render());
  world.boxes[3].high.z() += 0.02;  // 6 cm tall before: its centroid stays within a centimetre
  counting.perceiver.Perceive(world.Render());
  EXPECT_EQ(counting.calls, 4);
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
