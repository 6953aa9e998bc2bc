// Which of the planes in a room is the table, and that nothing but what stands on it is an object.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "services/perception/segmentation_fast.h"
#include "tests/perception/box_world.h"

namespace beckon::perception {
namespace {

/// A world whose first box is the table, followed by `n_things` on it, and by what else there is.
struct Room {
  BoxWorld world;
  int n_things = 0;
};

/// Three things on a table of medium size.
Room TableInARoom() {
  Room room;
  room.world.width = 640;
  room.world.height = 480;
  room.world.noise_m = kKinectNoise_m;
  room.world.boxes = {{{-0.45, 0.5, -0.03}, {0.3, 1.2, 0}},
                      Standing(-0.2, 0.65, 0.1, 0.08, 0.12),
                      Standing(0.15, 0.75, 0.08, 0.08, 0.2),
                      Standing(-0.1, 0.95, 0.15, 0.1, 0.06)};
  room.n_things = 3;
  return room;
}

std::ptrdiff_t PixelsOf(const std::vector<int>& truth, size_t box) {
  return std::count(truth.begin(), truth.end(), static_cast<int>(box) + 1);
}

/// The table is found where it is. At least `share` of what is seen of each thing on it is one
/// object, and nothing else is any.
void ExpectOnlyWhatStandsOnTheTable(const Room& room, const Segmentation& result,
                                    const std::vector<int>& truth, double share = 0.8) {
  ASSERT_TRUE(result.table_C) << result.reason;
  EXPECT_NEAR(result.table_C->offset_m, room.world.camera_height_m, 0.006);
  std::map<int, std::map<int, int>> labels_of;
  std::map<int, int> size_of;
  int n_astray = 0;
  for (size_t i = 0; i < truth.size(); ++i) {
    ++labels_of[truth[i]][result.labels[i]];
    ++size_of[truth[i]];
    n_astray += result.labels[i] != 0 && (truth[i] < 2 || truth[i] > 1 + room.n_things);
  }
  EXPECT_LT(n_astray, 100) << "pixels of objects that are of no thing on the table";
  std::set<int> objects;
  for (int thing = 2; thing < 2 + room.n_things; ++thing) {
    const auto& labels = labels_of[thing];
    const auto most = std::max_element(labels.begin(), labels.end(),
                                       [](auto& a, auto& b) { return a.second < b.second; });
    ASSERT_NE(most, labels.end()) << "thing " << thing << " is out of view";
    EXPECT_GT(most->second, share * size_of[thing]) << "thing " << thing;
    EXPECT_NE(most->first, 0) << "thing " << thing;
    objects.insert(most->first);
  }
  EXPECT_EQ(static_cast<int>(objects.size()), room.n_things);
}

void ExpectOnlyWhatStandsOnTheTable(const Room& room) {
  std::vector<int> truth;
  const RgbdImage image = room.world.Render(&truth);
  const Segmentation result = SegmentFast(image, {});
  ExpectOnlyWhatStandsOnTheTable(room, result, truth);
  EXPECT_EQ(result.n_objects, room.n_things);
}

TEST(SegmentFastInRooms, TakesTheLargerOfTwoTablesWhicheverIsHigher) {
  for (double height_m : {-0.4, -0.25, -0.12, -0.06, 0.06, 0.12, 0.25}) {
    SCOPED_TRACE(height_m);
    Room room = TableInARoom();
    room.world.boxes.push_back({{0.36, 0.5, height_m - 0.03}, {0.9, 1.1, height_m}});
    room.world.boxes.push_back(At(0.45, 0.65, height_m, 0.07, 0.07, 0.1));
    room.world.boxes.push_back(At(0.55, 0.9, height_m, 0.1, 0.08, 0.15));
    ExpectOnlyWhatStandsOnTheTable(room);
  }
}

TEST(SegmentFastInRooms, ATrayBeforeTheTableAndWhatIsOnItAreNoObjects) {
  for (double height_m : {-0.25, -0.18, -0.1, 0.1, 0.18, 0.25}) {
    SCOPED_TRACE(height_m);
    Room room = TableInARoom();
    room.world.pitch_deg = 48;
    room.world.boxes.push_back({{-0.15, 0.3, height_m - 0.01}, {0.15, 0.45, height_m}});
    room.world.boxes.push_back(At(-0.08, 0.37, height_m, 0.06, 0.06, 0.09));
    room.world.boxes.push_back(At(0.08, 0.38, height_m, 0.08, 0.05, 0.04));
    ExpectOnlyWhatStandsOnTheTable(room);
  }
}

TEST(SegmentFastInRooms, TakesTheTableWhereWallAndFloorAreBothLarger) {
  Room room = TableInARoom();
  room.world.pitch_deg = 25;
  room.world.camera_height_m = 0.5;
  room.world.boxes[0] = {{-0.3, 0.55, -0.03}, {0.25, 1.05, 0}};
  room.world.boxes.push_back({{-3, -1, -0.78}, {3, 4, -0.75}});
  room.world.boxes.push_back({{-3, 2.1, -0.75}, {3, 2.2, 3}});
  std::vector<int> truth;
  room.world.Render(&truth);
  for (size_t larger : {4u, 5u}) ASSERT_GT(PixelsOf(truth, larger), PixelsOf(truth, 0));
  ExpectOnlyWhatStandsOnTheTable(room);
}

/// The table seen steeply from above.
Room FromAbove(double pitch_deg) {
  Room room = TableInARoom();
  room.world.camera_height_m = 0.9;
  room.world.pitch_deg = pitch_deg;
  const double ahead_m = 0.9 / std::tan(pitch_deg * std::numbers::pi / 180);
  room.world.boxes = {{{-0.4, ahead_m - 0.3, -0.03}, {0.4, ahead_m + 0.3, 0}},
                      Standing(-0.2, ahead_m + 0.1, 0.1, 0.08, 0.12),
                      Standing(0.15, ahead_m - 0.1, 0.08, 0.08, 0.2),
                      Standing(0.02, ahead_m + 0.12, 0.15, 0.1, 0.06)};
  return room;
}

TEST(SegmentFastInRooms, ACameraThatLooksStraightDownFindsNoTableAndSaysWhatToSet) {
  for (double pitch_deg : {82.0, 90.0, 94.0}) {
    SCOPED_TRACE(pitch_deg);
    const Segmentation result = SegmentFast(FromAbove(pitch_deg).world.Render(), {});
    EXPECT_FALSE(result.table_C);
    EXPECT_THAT(result.reason, testing::HasSubstr("straight down"));
    EXPECT_THAT(result.reason, testing::HasSubstr("table_max_tilt_deg"));
  }
}

TEST(SegmentFastInRooms, ACameraThatMayLookStraightDownFindsTheTable) {
  SegmentationConfig config;
  config.table_max_tilt_deg = 95;
  for (double pitch_deg : {70.0, 82.0, 90.0, 94.0}) {
    SCOPED_TRACE(pitch_deg);
    const Room room = FromAbove(pitch_deg);
    std::vector<int> truth;
    const RgbdImage image = room.world.Render(&truth);
    const Segmentation result = SegmentFast(image, config);
    // The tops: sides that are seen at a grazing angle may be objects of their own.
    ExpectOnlyWhatStandsOnTheTable(room, result, truth, 0.6);
  }
}

TEST(SegmentFastInRooms, AWallIsNoTableForACameraThatMayLookStraightDownButLooksAhead) {
  SegmentationConfig config;
  config.table_max_tilt_deg = 95;
  BoxWorld wall;
  wall.pitch_deg = 10;
  wall.boxes = {{{-3, 1.5, -1}, {3, 1.6, 3}}};
  const Segmentation result = SegmentFast(wall.Render(), config);
  EXPECT_FALSE(result.table_C);
  EXPECT_THAT(result.reason, testing::HasSubstr("tilted"));
}

TEST(SegmentFastInRooms, ACameraUpsideDownFindsNoTableAndSaysSo) {
  Room room = TableInARoom();
  RgbdImage image = room.world.Render();
  std::reverse(image.depth_m.begin(), image.depth_m.end());
  const Segmentation result = SegmentFast(image, {});
  EXPECT_FALSE(result.table_C);
  EXPECT_THAT(result.reason, testing::HasSubstr("upside down"));
  EXPECT_EQ(result.n_objects, 0);
  SegmentationConfig config;
  config.table_max_tilt_deg = 180;
  EXPECT_EQ(SegmentFast(image, config).n_objects, room.n_things);
}

}  // namespace
}  // namespace beckon::perception
