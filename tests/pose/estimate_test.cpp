// An object alone, and objects together.
#include "services/pose/estimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

TEST(Estimate, TurnsThePlaneToTheCamera) {
  const TableView view = ViewOnTable(MakeShape({0.033, 0.033, 0.06}, 0.2, 1, {0, 0, 0.06}), 2000);
  const Plane flipped{-view.table_C.normal, -view.table_C.offset_m};
  const Estimate a = EstimateObject({view.points_C, view.table_C}, {});
  const Estimate b = EstimateObject({view.points_C, flipped}, {});
  EXPECT_EQ(a.fit.shape.semi_axes, b.fit.shape.semi_axes);
  EXPECT_FALSE(a.grasps.empty());
  EXPECT_EQ(a.grasps.size(), b.grasps.size());
  EXPECT_TRUE(EstimateObject({view.points_C, {}}, {}).grasps.empty());
}

TEST(Estimate, OfASceneKeepsGraspsOffTheNeighbours) {
  TableView near = ViewOnTable(MakeShape({0.02, 0.03, 0.05}, 0.1, 0.1, {0, 0, 0.05}), 1500);
  TableView beside = ViewOnTable(MakeShape({0.02, 0.03, 0.05}, 0.1, 0.1, {0.05, 0, 0.05}), 1500);
  const FitInput inputs[] = {{near.points_C, near.table_C}, {beside.points_C, beside.table_C}};
  const auto scene = EstimateScene(inputs, {});
  const auto alone = EstimateObject(inputs[0], {});
  ASSERT_EQ(scene.size(), 2u);
  ASSERT_TRUE(scene[0].fit.converged && scene[1].fit.converged);
  EXPECT_EQ(scene[0].fit.shape.semi_axes, alone.fit.shape.semi_axes);
  const auto across = [&](const std::vector<GraspCandidate>& grasps) {  // towards the other
    return std::count_if(grasps.begin(), grasps.end(), [](const GraspCandidate& g) {
      return std::abs(g.X_FG.linear()(0, 0)) > 0.9;
    });
  };
  EXPECT_GT(across(alone.grasps), 0);
  EXPECT_EQ(across(scene[0].grasps), 0);
  EXPECT_FALSE(scene[0].grasps.empty());
}

TEST(Estimate, OfASceneTimesTheFitAndTheGraspsOfEachObject) {
  const TableView box = ViewOnTable(MakeShape({0.02, 0.03, 0.05}, 0.1, 0.1, {0, 0, 0.05}), 500);
  const FitInput inputs[] = {{box.points_C, box.table_C}, {box.points_C, box.table_C}};
  double now_ms = 100;
  const auto estimates = EstimateScene(inputs, {}, [&] { return now_ms += 5; });
  ASSERT_EQ(estimates.size(), 2u);
  for (const Estimate& estimate : estimates) EXPECT_EQ(estimate.time_ms, 2 * 5);
  EXPECT_EQ(EstimateScene(inputs, {})[0].time_ms, 0);
}

}  // namespace
}  // namespace beckon::pose
