// Objects keep ids and shapes through what happens on a table, in a world whose segmentation is
// known, and wrong only where a test wants it to be.
#include "services/perception/object_memory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "tests/perception/box_world.h"

namespace beckon::perception {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

constexpr Rgb kRed{200, 40, 40}, kGreen{40, 190, 60}, kGrey{150, 150, 150};

/// A world, and memory that looks at it. Box b of the world (0 is the table) is truly label b.
class ObjectMemoryTest : public testing::Test {
 protected:
  ObjectMemoryTest() {
    world_.boxes[1].colour = kRed;
    world_.boxes[2].colour = kGreen;
    world_.noise_m = 0.001;
  }

  /// The next frame, after `spoil` did what it likes to its labels. `number`: close the gaps that
  /// it may have left in their numbers.
  template <typename Spoil>
  void Look(Spoil spoil, bool number = true) {
    std::vector<int> box_of_pixel;
    image_ = world_.Render(&box_of_pixel, ++seed_);
    segmentation_ = {};
    segmentation_.table_C = Plane{};
    segmentation_.n_objects = static_cast<int>(world_.boxes.size()) - 1;
    segmentation_.labels.resize(box_of_pixel.size());
    for (size_t i = 0; i < box_of_pixel.size(); ++i) {
      segmentation_.labels[i] = static_cast<uint16_t>(std::max(0, box_of_pixel[i] - 1));
    }
    truth_ = segmentation_.labels;
    spoil(segmentation_.labels);
    if (number) Number();
    objects_ = memory_.Update(image_, 64, segmentation_);
  }
  void Look(int n_frames = 1) {
    for (int i = 0; i < n_frames; ++i) Look([](auto&) {});
  }

  /// Closes the gaps in the numbers of the labels.
  void Number() {
    std::map<uint16_t, uint16_t> number;
    for (uint16_t& label : segmentation_.labels) {
      if (label == 0) continue;
      const auto next = static_cast<uint16_t>(number.size() + 1);
      label = number.emplace(label, next).first->second;
    }
    segmentation_.n_objects = static_cast<int>(number.size());
  }

  /// The id that most pixels of a box have; 0 = none.
  int IdOf(int box) const {
    std::map<int, int> n_pixels;
    for (size_t i = 0; i < truth_.size(); ++i) {
      if (truth_[i] != box) continue;
      const int k = segmentation_.labels[i];
      ++n_pixels[k == 0 ? 0 : objects_.ids[k - 1]];
    }
    int best = 0;
    for (const auto& [id, n] : n_pixels) best = n > n_pixels[best] ? id : best;
    return best;
  }

  void Shift(int box, double dx_m, double dy_m = 0, double dz_m = 0) {
    world_.boxes[box].low += Eigen::Vector3d(dx_m, dy_m, dz_m);
    world_.boxes[box].high += Eigen::Vector3d(dx_m, dy_m, dz_m);
  }

  std::set<int> Ids() const { return {objects_.ids.begin(), objects_.ids.end()}; }

  BoxWorld world_ = ThreeBoxes();
  ObjectMemory memory_{{}, SensorNoise{}};
  RgbdImage image_;
  std::vector<uint16_t> truth_;  // labels of the last frame, as they should be
  Segmentation segmentation_;
  SteadyObjects objects_;
  unsigned seed_ = 0;
};

/// Makes the right half of a label's pixels another label.
void Split(std::vector<uint16_t>& labels, int width, uint16_t label, uint16_t into) {
  int left = width, right = 0;
  for (size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] != label) continue;
    left = std::min(left, static_cast<int>(i) % width);
    right = std::max(right, static_cast<int>(i) % width);
  }
  for (size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] == label && static_cast<int>(i) % width > (left + right) / 2) labels[i] = into;
  }
}

TEST_F(ObjectMemoryTest, TheFirstFrameStaysAsItIs) {
  Look();
  EXPECT_EQ(segmentation_.n_objects, 3);
  EXPECT_THAT(objects_.ids, ElementsAre(1, 2, 3));
  for (size_t i = 0; i < truth_.size(); ++i)
    ASSERT_EQ(truth_[i] != 0, segmentation_.labels[i] != 0);
  EXPECT_EQ(objects_.silhouettes, segmentation_.labels);
}

TEST_F(ObjectMemoryTest, HowSegmentationNumbersObjectsIsNoMatter) {
  Look();
  const int first = IdOf(1), second = IdOf(2), third = IdOf(3);
  for (int turn = 0; turn < 3; ++turn) {
    Look(
        [&](auto& labels) {
          for (uint16_t& label : labels) {
            if (label > 0) label = static_cast<uint16_t>(1 + (label + turn) % 3);
          }
        },
        false);
    EXPECT_EQ(IdOf(1), first);
    EXPECT_EQ(IdOf(2), second);
    EXPECT_EQ(IdOf(3), third);
  }
}

TEST_F(ObjectMemoryTest, WithoutSteadinessEveryFrameStaysAsItIs) {
  memory_ = ObjectMemory({.steady = false}, SensorNoise{});
  for (int frame = 0; frame < 10; ++frame) {
    Look([&](auto& labels) {
      if (frame % 2 == 1) std::replace(labels.begin(), labels.end(), 2, 0);
    });
    EXPECT_EQ(segmentation_.n_objects, frame % 2 == 1 ? 2 : 3) << frame;
  }
}

TEST_F(ObjectMemoryTest, WhatIsWrongInAFrameDoesNotShow) {
  Look(10);
  const auto shape = objects_.silhouettes;
  const auto ids = objects_.ids;
  const std::vector<std::function<void(std::vector<uint16_t>&)>> errors = {
      [&](auto& labels) { Split(labels, image_.width, 1, 9); },
      [](auto& labels) { std::replace(labels.begin(), labels.end(), 1, 2); },
      [](auto& labels) { std::replace(labels.begin(), labels.end(), 3, 0); },
      [](auto& labels) { std::fill(labels.begin(), labels.end(), 0); }};
  for (const auto& error : errors) {
    Look(error);
    EXPECT_EQ(objects_.silhouettes, shape);
    EXPECT_EQ(objects_.ids, ids);
    Look(4);
    EXPECT_EQ(objects_.silhouettes, shape);
    EXPECT_EQ(objects_.ids, ids);
  }
}

TEST_F(ObjectMemoryTest, WhatIsSaidLongEnoughIsBelieved) {
  Look(10);
  for (int i = 0; i < 40; ++i) Look([&](auto& labels) { Split(labels, image_.width, 1, 9); });
  EXPECT_EQ(objects_.ids.size(), 4u) << "an object parts";
  for (int i = 0; i < 40; ++i) Look();
  EXPECT_EQ(objects_.ids.size(), 3u) << "and joins again";
  for (int i = 0; i < 40; ++i) {
    Look([](auto& labels) { std::replace(labels.begin(), labels.end(), 3, 0); });
  }
  EXPECT_EQ(objects_.ids.size(), 2u) << "or is none";
}

TEST_F(ObjectMemoryTest, ErrorsOfTheFirstFrameAreSoonOutvoted) {
  Look([&](auto& labels) { Split(labels, image_.width, 1, 9); });
  EXPECT_EQ(objects_.ids.size(), 4u);
  Look(4);
  EXPECT_EQ(objects_.ids.size(), 3u);
}

TEST_F(ObjectMemoryTest, ARemovedObjectIsGoneAtOnceAndComesBackAsItself) {
  Look(10);
  const int id = IdOf(2);
  const WorldBox box = world_.boxes[2];
  world_.boxes[2].high.z() = -1;  // under the table
  world_.boxes[2].low.z() = -1.1;
  for (int frame = 0; frame < 60; ++frame) {
    Look();
    EXPECT_FALSE(Ids().contains(id));
    EXPECT_EQ(objects_.ids.size(), 2u);
  }
  EXPECT_TRUE(memory_.Remembers(id));
  world_.boxes[2] = box;
  Look();
  EXPECT_EQ(IdOf(2), id);
}

TEST_F(ObjectMemoryTest, AnotherObjectInItsPlaceIsAnother) {
  Look(10);
  const int id = IdOf(2);
  world_.boxes.erase(world_.boxes.begin() + 2);
  Look(3);
  world_.boxes.push_back(Standing(0.15, 0.7, 0.2, 0.05, 0.05));
  world_.boxes.back().colour = kRed;
  Look(3);
  EXPECT_EQ(objects_.ids.size(), 3u);
  EXPECT_FALSE(Ids().contains(id));
}

TEST_F(ObjectMemoryTest, AnObjectThatIsMovedKeepsItsId) {
  Look(10);
  const int id = IdOf(1);
  for (int i = 0; i < 10; ++i) {
    Shift(1, 0.01, -0.01);  // 0.4 m/s at 30 Hz
    Look();
    EXPECT_EQ(IdOf(1), id);
  }
  Shift(1, -0.1, 0.05);  // in one frame
  Look();
  EXPECT_EQ(IdOf(1), id);
  EXPECT_EQ(objects_.ids.size(), 3u);
}

TEST_F(ObjectMemoryTest, AnObjectThatMovedLeavesNothingBehind) {
  Look(10);
  for (int i = 0; i < 10; ++i) {
    Shift(1, 0.01);
    Look();
    int wrong = 0, n = 0;
    for (size_t i_px = 0; i_px < truth_.size(); ++i_px) {
      const bool is = truth_[i_px] == 1;
      const int k = segmentation_.labels[i_px];
      n += is;
      wrong += is != (k > 0 && objects_.ids[k - 1] == IdOf(1));
    }
    EXPECT_LT(wrong, n / 8);
  }
}

TEST_F(ObjectMemoryTest, WhatPassesBeforeObjectsLeavesTheirIdsAlone) {
  Look(10);
  const int first = IdOf(1), second = IdOf(2), third = IdOf(3);
  world_.boxes.push_back(Standing(-0.35, 0.45, 0.1, 0.02, 0.25));
  world_.boxes.back().colour = kGrey;
  bool hidden = false;
  for (int i = 0; i < 36; ++i) {
    Shift(4, 0.02);
    Look();
    for (const auto& [box, id] : {std::pair(1, first), {2, second}, {3, third}}) {
      const int now = IdOf(box);
      EXPECT_TRUE(now == id || now == 0) << "box " << box << ", frame " << i << ": " << now;
      hidden |= std::count(truth_.begin(), truth_.end(), box) < 100;
    }
  }
  world_.boxes.pop_back();
  Look();
  EXPECT_TRUE(hidden) << "of the test: the box should hide something";
  EXPECT_THAT(Ids(), UnorderedElementsAre(first, second, third));
  EXPECT_EQ(IdOf(2), second);
}

TEST_F(ObjectMemoryTest, AnObjectCutInTwoByAnotherStaysOne) {
  Look(10);
  const int id = IdOf(3);
  world_.boxes.push_back(Standing(0.01, 0.7, 0.03, 0.02, 0.3));
  world_.boxes.back().colour = kGrey;
  for (int frame = 0; frame < 40; ++frame) {
    Look([&](auto& labels) { Split(labels, image_.width, 3, 9); });
    ASSERT_EQ(IdOf(3), id) << frame;
    ASSERT_EQ(objects_.ids.size(), 4u) << frame;
  }
}

TEST_F(ObjectMemoryTest, AnObjectHiddenAndTakenAwayBehindIsGone) {
  Look(10);
  const int id = IdOf(2);
  world_.boxes.push_back(Standing(0.12, 0.5, 0.2, 0.02, 0.4));
  world_.boxes.back().colour = kGrey;
  Look(10);
  EXPECT_FALSE(Ids().contains(id));
  EXPECT_TRUE(memory_.Remembers(id));
  world_.boxes.pop_back();
  world_.boxes.erase(world_.boxes.begin() + 2);
  Look();
  EXPECT_EQ(objects_.ids.size(), 2u);
  EXPECT_FALSE(Ids().contains(id));
}

TEST_F(ObjectMemoryTest, AlikeObjectsThatPassEachOtherKeepTheirIds) {
  world_.boxes = {Table(), Standing(-0.2, 0.55, 0.08, 0.06, 0.08),
                  Standing(0.2, 0.85, 0.08, 0.06, 0.08)};
  Look(10);
  const int near = IdOf(1), far = IdOf(2);
  for (int i = 0; i < 27; ++i) {
    Shift(1, 0.015);
    Shift(2, -0.015);
    Look();
    EXPECT_EQ(IdOf(1), near) << i;
    if (IdOf(2) != 0) EXPECT_EQ(IdOf(2), far) << i;
  }
}

TEST_F(ObjectMemoryTest, ExchangedObjectsAreToldApartByTheirLooksAlikeOnesByTheirPlaces) {
  for (const bool alike : {false, true}) {
    memory_ = ObjectMemory({}, SensorNoise{});
    world_.boxes = {Table(), Standing(-0.15, 0.6, 0.08, 0.08, 0.1),
                    Standing(0.15, 0.7, 0.08, 0.08, 0.1)};
    world_.boxes[1].colour = kRed;
    world_.boxes[2].colour = alike ? kRed : kGreen;
    Look(10);
    const int first = IdOf(1), second = IdOf(2);
    const auto boxes = world_.boxes;
    world_.boxes.resize(1);
    Look(5);
    world_.boxes = boxes;
    Shift(1, 0.3, 0.1);
    Shift(2, -0.3, -0.1);
    Look();
    EXPECT_EQ(IdOf(1), alike ? second : first);
    EXPECT_EQ(IdOf(2), alike ? first : second);
  }
}

TEST_F(ObjectMemoryTest, WhatIsHiddenForTooLongIsForgotten) {
  memory_ = ObjectMemory({.forget_after_frames = 20}, SensorNoise{});
  Look(10);
  const int id = IdOf(2);
  world_.boxes.push_back(Standing(0.12, 0.5, 0.2, 0.02, 0.4));
  Look(19);
  EXPECT_TRUE(memory_.Remembers(id));
  Look(3);
  EXPECT_FALSE(memory_.Remembers(id));
  world_.boxes.pop_back();
  Look();
  EXPECT_GT(IdOf(2), 3) << "no id is given twice";
}

TEST_F(ObjectMemoryTest, AFrameWithoutATableOrOfAnotherSizeIsNoTrouble) {
  Look(10);
  const auto ids = Ids();
  Segmentation none;
  none.labels.assign(image_.depth_m.size(), 0);
  EXPECT_THAT(memory_.Update(image_, 64, none).ids, IsEmpty());
  Look();
  EXPECT_EQ(Ids(), ids);
  world_.width = 640;
  world_.height = 480;
  Look();
  EXPECT_EQ(Ids(), ids) << "places and looks are the same";
  world_.width = 17;
  world_.height = 3;
  Look();
}

TEST_F(ObjectMemoryTest, HoldsNoMoreObjectsThanItHasRoomForAndGoesOn) {
  Look(10);
  const auto ids = Ids();
  for (int frame = 0; frame < 40; ++frame) {
    Look([&](auto& labels) {  // 40 bits of table, elsewhere in every frame
      for (int k = 0; k < 40; ++k)
        labels[(frame * 977 + k * 131) % labels.size()] = static_cast<uint16_t>(100 + k);
    });
  }
  Look(40);
  EXPECT_EQ(Ids(), ids);
}

}  // namespace
}  // namespace beckon::perception
