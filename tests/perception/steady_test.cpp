// Objects on the embedded scene's table keep ids, outlines and places over noisy frames, and what
// really changes is noticed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <set>

#include "services/perception/perceiver.h"
#include "tests/perception/steady_table.h"

namespace beckon::perception {
namespace {

cv::Mat Filled(const RgbdImage& image, const PerceivedObject& object) {
  cv::Mat mask = cv::Mat::zeros(image.height, image.width, CV_8U);
  std::vector<cv::Point> polygon;
  for (const auto& [u, v] : object.shape.outline_px) polygon.emplace_back(u, v);
  cv::fillPoly(mask, std::vector{polygon}, 1);
  return mask;
}

double Overlap(const cv::Mat& a, const cv::Mat& b) {
  return static_cast<double>(cv::countNonZero(a & b)) / cv::countNonZero(a | b);
}

std::set<int> Ids(const Perception& perception) {
  std::set<int> ids;
  for (const auto& object : perception.objects) ids.insert(object.id);
  return ids;
}

/// The id of the object that has most of the pixels of a true label; 0 = less than a third of them
/// are any object's.
int IdOf(const Perception& perception, const std::vector<uint16_t>& truth, int object) {
  const auto n = std::count(truth.begin(), truth.end(), object + 1);
  for (const auto& o : perception.objects) {
    const auto hits = std::count_if(o.shape.pixels.begin(), o.shape.pixels.end(),
                                    [&](uint32_t pixel) { return truth[pixel] == object + 1; });
    if (hits * 3 > n) return o.id;
  }
  return 0;
}

constexpr int kSettling = 25;  // frames after which errors of the first are outvoted

/// How objects were shown over many frames.
struct Steadiness {
  double least_overlap = 1;    // of an object's outlines in consecutive frames
  double most_centroid_m = 0;  // standard deviation of a centroid in W
  int frames_with_other_ids = 0;
};

double Deviation(const std::vector<Eigen::Vector3d>& places) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& p : places) mean += p / static_cast<double>(places.size());
  double variance = 0;
  for (const auto& p : places) {
    variance += (p - mean).squaredNorm() / static_cast<double>(places.size());
  }
  return std::sqrt(variance);
}

Steadiness Watch(SteadyTable& table, Perceiver& perceiver, int n_frames) {
  Steadiness result;
  std::map<int, cv::Mat> last;
  std::map<int, std::vector<Eigen::Vector3d>> centroids;
  std::set<int> ids;
  for (int frame = 0; frame < n_frames; ++frame) {
    const RgbdImage image = table.Next();
    const Perception perception = perceiver.Perceive(image);
    if (frame == 0) ids = Ids(perception);
    result.frames_with_other_ids += Ids(perception) != ids;
    for (const auto& object : perception.objects) {
      cv::Mat mask = Filled(image, object);
      if (last.contains(object.id)) {
        result.least_overlap = std::min(result.least_overlap, Overlap(mask, last[object.id]));
      }
      last[object.id] = mask;
      centroids[object.id].push_back(object.shape.centroid_W);
    }
  }
  for (const auto& [id, places] : centroids) {
    result.most_centroid_m = std::max(result.most_centroid_m, Deviation(places));
  }
  return result;
}

/// Eight objects that have settled, and their ids.
class SteadyTest : public testing::Test {
 protected:
  void SetUp() override {
    for (int frame = 0; frame < kSettling; ++frame) Look();
    for (int k = 0; k < table_.n_objects(); ++k) ids_.push_back(IdOf(now_, table_.labels(), k));
  }

  void Look() { now_ = perceiver_.Perceive(table_.Next()); }

  /// All objects but `except` have the ids they had.
  void ExpectOthersStay(const std::set<int>& except) {
    for (size_t k = 0; k < ids_.size(); ++k) {
      if (except.contains(static_cast<int>(k))) continue;
      EXPECT_EQ(IdOf(now_, table_.labels(), static_cast<int>(k)), ids_[k]) << "object " << k;
    }
  }

  SteadyTable table_{3, 8};
  Perceiver perceiver_{{}, nullptr};
  Perception now_;
  std::vector<int> ids_;
};

TEST_F(SteadyTest, AStaticTableIsShownTheSameForAHundredNoisyFrames) {
  EXPECT_THAT(ids_, testing::Each(testing::Gt(0)));
  EXPECT_EQ(std::set<int>(ids_.begin(), ids_.end()).size(), ids_.size());
  const Steadiness steadiness = Watch(table_, perceiver_, 100);
  EXPECT_EQ(steadiness.frames_with_other_ids, 0);
  EXPECT_GE(steadiness.least_overlap, 0.95);
  EXPECT_LT(steadiness.most_centroid_m, 0.002);
  RecordProperty("least_overlap", std::to_string(steadiness.least_overlap));
  RecordProperty("most_centroid_m", std::to_string(steadiness.most_centroid_m));
}

TEST_F(SteadyTest, WithoutSteadinessTheSameTableFlickers) {
  PerceiverConfig config;
  config.tracker.steady = false;
  Perceiver perceiver(config, nullptr);
  EXPECT_LT(Watch(table_, perceiver, 20).least_overlap, 0.95);
}

TEST_F(SteadyTest, ARemovedObjectIsGoneWithinThreeFrames) {
  table_.Remove(1);
  for (int frame = 0; frame < 3; ++frame) Look();
  EXPECT_FALSE(Ids(now_).contains(ids_[1]));
  ExpectOthersStay({1});
  for (int frame = 0; frame < 10; ++frame) Look();
  EXPECT_FALSE(Ids(now_).contains(ids_[1]));
  table_.PutBack(1);
  for (int frame = 0; frame < 3; ++frame) Look();
  ExpectOthersStay({});
}

TEST_F(SteadyTest, AMovedObjectIsFoundWithinThreeFramesAndKeepsItsId) {
  table_.Move(0, -0.04, -0.08);
  for (int frame = 0; frame < 3; ++frame) Look();
  ExpectOthersStay({});
  for (int step = 0; step < 8; ++step) {
    table_.Move(0, 0.01, 0.005);
    Look();
    EXPECT_EQ(IdOf(now_, table_.labels(), 0), ids_[0]) << "step " << step;
  }
  ExpectOthersStay({});
}

TEST_F(SteadyTest, WhatPassesBeforeThemForASecondLeavesObjectsAsTheyWere) {
  const auto ids = Ids(now_);
  const int box = table_.AddBox({0.1, 0.02, 0.2}, {-0.45, table_.aim_y_m() - 0.2, 0}, {90, 90, 90});
  for (int frame = 0; frame < 30; ++frame) {
    table_.Move(box, 0.03, 0);
    Look();
    for (size_t k = 0; k < ids_.size(); ++k) {
      const int id = IdOf(now_, table_.labels(), static_cast<int>(k));
      EXPECT_TRUE(id == 0 || id == ids_[k]) << "object " << k << ", frame " << frame << ": " << id;
    }
  }
  table_.Remove(box);
  for (int frame = 0; frame < 3; ++frame) Look();
  EXPECT_EQ(Ids(now_), ids);
  ExpectOthersStay({});
}

}  // namespace
}  // namespace beckon::perception
