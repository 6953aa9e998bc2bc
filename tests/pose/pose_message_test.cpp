// What POSES tell, and that they fit one datagram.
#include "services/pose/pose_message.h"

#include <gtest/gtest.h>

#include "lcmtypes/codec.h"
#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

/// With as many grasps, alternatives and parts.
Estimate Rich(size_t grasps, size_t alternatives, size_t parts) {
  Estimate estimate;
  estimate.fit.shape = MakeShape({0.03, 0.04, 0.06}, 0.1, 0.1, {0, 0, 0.7});
  estimate.fit.converged = true;
  for (size_t i = 0; i < alternatives; ++i) {
    estimate.fit.alternatives.push_back(
        MakeShape({0.03, 0.04, 0.07}, 0.1, 1, {0.1 * static_cast<double>(i), 0, 0.7}, {0.2, 0, 0}));
    estimate.fit.alternatives.back().taper = {0.1, -0.2};
  }
  for (size_t i = 0; i < parts; ++i) {
    estimate.fit.parts.push_back(
        MakeShape({0.03, 0.02, 0.05}, 0.5, 1, {0, 0.1 * static_cast<double>(i), 0.7}));
  }
  for (size_t i = 0; i < grasps; ++i) {
    estimate.grasps.push_back({Pose::Identity(), 0.05, 1 - 0.01 * static_cast<double>(i)});
  }
  return estimate;
}

msg::Poses PosesOf(const Estimate& estimate, int count) {
  msg::Poses poses{.utime = 1, .seq = 1, .scene_seq = 1, .poses = {}};
  for (int i = 0; i < count; ++i) {
    poses.poses.push_back(ToMessage(estimate, WorldFromTable({{0, -0.8, -0.6}, 0.6}), i + 1, 1));
  }
  return poses;
}

TEST(PoseMessage, MovesAlternativesAndPartsToTheTablesFrame) {
  const Estimate estimate = Rich(1, 2, 3);
  const Pose X_WC = WorldFromTable({{0, -0.8, -0.6}, 0.6});
  const msg::ObjectPose message = ToMessage(estimate, X_WC, 5, 1);
  ASSERT_EQ(message.alternatives.size(), 2u);
  ASSERT_EQ(message.parts.size(), 3u);
  const auto expect_same = [&](const msg::SuperquadricShape& told, const Superquadric& shape_C) {
    EXPECT_LT((told.X_WO.matrix() - (X_WC * shape_C.X_FO).matrix()).norm(), 1e-9);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(told.semi_axes[i], shape_C.semi_axes[i]);
    for (int i = 0; i < 2; ++i) EXPECT_EQ(told.epsilon[i], shape_C.epsilon[i]);
    for (int i = 0; i < 2; ++i) EXPECT_EQ(told.taper[i], shape_C.taper[i]);
  };
  for (size_t i = 0; i < 2; ++i) expect_same(message.alternatives[i], estimate.fit.alternatives[i]);
  for (size_t i = 0; i < 3; ++i) expect_same(message.parts[i], estimate.fit.parts[i]);
}

TEST(PoseMessage, TellsNoMoreThanAMessageMay) {
  const msg::Poses poses = PosesOf(Rich(30, 9, 9), 1);
  EXPECT_TRUE(Codec<msg::Poses>::Encode(poses));
  EXPECT_EQ(poses.poses[0].grasps.size(), 16u);
  EXPECT_EQ(poses.poses[0].grasps[0].score, 1);
  EXPECT_EQ(poses.poses[0].alternatives.size(), 4u);
  EXPECT_TRUE(poses.poses[0].parts.empty()) << "some parts are not the object";
  EXPECT_TRUE(PosesOf(Rich(0, 0, 1), 1).poses[0].parts.empty());
}

TEST(FitDatagram, LeavesAloneWhatFits) {
  msg::Poses poses = PosesOf(Rich(16, 4, 8), 20);
  FitDatagram(poses);
  EXPECT_TRUE(Codec<msg::Poses>::Encode(poses));
  for (const auto& pose : poses.poses) {
    EXPECT_EQ(pose.grasps.size(), 16u);
    EXPECT_EQ(pose.alternatives.size(), 4u);
    EXPECT_EQ(pose.parts.size(), 8u);
  }
}

TEST(FitDatagram, ShortensWhatCanBeMissedUntilItFits) {
  for (const auto& [grasps, alternatives, parts, reason] :
       std::initializer_list<std::tuple<size_t, size_t, size_t, size_t>>{
           {16, 0, 0, 0}, {16, 4, 0, 0}, {16, 4, 2, 0}, {16, 4, 8, 0}, {16, 4, 8, 1024}}) {
    msg::Poses poses = PosesOf(Rich(grasps, alternatives, parts), 64);
    for (auto& pose : poses.poses) pose.reason = std::string(reason, 'x');
    EXPECT_FALSE(Codec<msg::Poses>::Encode(poses)) << "or there is nothing to do";
    FitDatagram(poses);
    const auto bytes = Codec<msg::Poses>::Encode(poses);
    ASSERT_TRUE(bytes) << bytes.error().message;
    EXPECT_GT(bytes->size(), 0.75 * msg::kMaxDatagram) << "no more than had to go";
    EXPECT_EQ(poses.poses.size(), 64u);
    for (const auto& pose : poses.poses) {
      if (reason == 0) {
        EXPECT_GE(pose.grasps.size(), 4u);
      }
      EXPECT_TRUE(pose.parts.empty() || pose.parts.size() == parts);
      if (!pose.grasps.empty()) {
        EXPECT_EQ(pose.grasps[0].score, 1) << "the best stay";
      }
    }
    if (parts == 0) {
      EXPECT_GE(poses.poses[63].alternatives.size(), std::min<size_t>(alternatives, 3));
    }
  }
}

}  // namespace
}  // namespace beckon::pose
