// The outline of views of known shapes.
#include "services/pose/silhouette.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

using Eigen::Vector3d;

const Vector3d kOrigin = Vector3d::Zero();
constexpr double kPixel_m = 0.8 / 525;  // at the distance of the views

PointList Widened(const std::vector<Eigen::Vector3f>& points) {
  PointList wide;
  for (const auto& p : points) wide.push_back(p.cast<double>());
  return wide;
}

Superquadric Ball() { return MakeShape({0.05, 0.05, 0.05}, 1, 1, {0, 0, 0.05}); }
Superquadric Box() { return MakeShape({0.04, 0.06, 0.09}, 0.1, 0.1, {0, 0, 0.09}, {0, 0, 0.5}); }

// How far each ray passes the shape, m; negative where it cuts through it.
std::vector<double> Misses(const Superquadric& shape, const PointBlock& rays) {
  PointBlock deepest;
  FindDeepest(shape, Vector3d::Zero(), rays, 30, deepest);
  BlockDistances distances;
  ComputeDistances(shape, deepest, distances);
  return {distances.begin(), distances.begin() + rays.size};
}

double TotalWeight(const PointBlock& block) {
  double sum = 0;
  for (int i = 0; i < block.size; ++i) {
    sum += static_cast<double>(block.weight[static_cast<size_t>(i)]);
  }
  return sum;
}

TEST(Silhouette, GrazesTheShape) {
  for (const Superquadric& shape_W : {Ball(), Box()}) {
    const TableView view = PixelViewOnTable(shape_W);
    const Silhouette silhouette = TraceSilhouette(Widened(view.points_C), {}, kOrigin, {}, {});
    EXPECT_GT(silhouette.rays_F.size, 40);
    EXPECT_LE(silhouette.rays_F.size, 96);
    EXPECT_NEAR(TotalWeight(silhouette.rays_F), 1, 1e-5);
    EXPECT_TRUE(silhouette.cuts.empty());
    double sum = 0;
    for (const double miss_m : Misses(view.shape_C, silhouette.rays_F)) {
      EXPECT_LT(std::abs(miss_m), kPixel_m);
      sum += miss_m;
    }
    EXPECT_LT(std::abs(sum / silhouette.rays_F.size), 0.3 * kPixel_m);  // neither in nor out
  }
}

TEST(Silhouette, LeavesOutWhatIsNearTheTable) {
  const TableView view = PixelViewOnTable(Box());
  const Silhouette silhouette =
      TraceSilhouette(Widened(view.points_C), {}, kOrigin, view.table_C, {});
  ASSERT_GT(silhouette.rays_F.size, 20);
  const SilhouetteConfig config;
  for (int i = 0; i < silhouette.rays_F.size; ++i) {
    const Vector3d ray = silhouette.rays_F.at(i);
    // The nearest that a point beside this ray may have been.
    const double depth_m = view.shape_C.X_FO.translation().norm() + 0.05;
    EXPECT_GT(view.table_C.Distance(depth_m * ray), config.table_margin_m - 0.05);
  }
}

TEST(Silhouette, OfABallHasNoStraightsAsLongAsACutMakes) {
  const Silhouette whole =
      TraceSilhouette(Widened(PixelViewOnTable(Ball()).points_C), {}, kOrigin, {}, {});
  std::vector<Eigen::Vector3f> points = PixelViewOnTable(Ball()).points_C;
  CutAway(0.4, 0.3, points);
  const Silhouette cut = TraceSilhouette(Widened(points), {}, kOrigin, {}, {});
  ASSERT_FALSE(cut.straights.empty());
  const auto longest = [](const Silhouette& s) {
    size_t most = 0;
    for (const Straight& straight : s.straights) most = std::max(most, straight.rays.size());
    return most;
  };
  EXPECT_LT(longest(whole), longest(cut));
}

TEST(Silhouette, FindsTheLineThatCutsAViewOff) {
  for (const Superquadric& shape_W : {Ball(), Box()}) {
    for (const double angle : {0.3, 1.2, 2.5, -0.7}) {
      std::vector<Eigen::Vector3f> points = PixelViewOnTable(shape_W).points_C;
      const CutLine line = CutAway(angle, 0.3, points);
      const Vector3d normal = Vector3d(line.normal.x(), line.normal.y(), -line.offset).normalized();
      const Silhouette silhouette = TraceSilhouette(Widened(points), {}, kOrigin, {}, {});
      const Straight* best = nullptr;
      for (const Straight& s : silhouette.straights) {
        EXPECT_NEAR(s.normal_F.norm(), 1, 1e-9);
        if (!best || s.normal_F.dot(normal) > best->normal_F.dot(normal)) best = &s;
      }
      ASSERT_TRUE(best) << angle;
      EXPECT_GT(best->normal_F.dot(normal), std::cos(0.06)) << angle;
      EXPECT_GT(best->width_rad, 0.04);
      for (const int i : best->rays) {
        // Within two pixels of the plane.
        EXPECT_LT(std::abs(normal.dot(silhouette.rays_F.at(i))), 4.0 / 525);
      }
    }
  }
}

// The rim of a ball in front of the viewpoint, counter-clockwise; `beyond` tells what is where.
template <typename Function>
std::vector<RimPoint> RimOfBall(const Function& beyond, int count = 64) {
  std::vector<RimPoint> rim;
  for (int i = 0; i < count; ++i) {
    const double turn = 2 * M_PI * i / count;
    const Vector3d p(0.0499 * std::cos(turn), 0.0499 * std::sin(turn), 0.8);
    rim.push_back({p.cast<float>(), beyond(turn)});
  }
  return rim;
}
const PointList& BallPoints() {
  static const PointList points =
      Widened(WholeSurface(MakeShape({0.05, 0.05, 0.05}, 1, 1, {0, 0, 0.8}), 500));
  return points;
}

TEST(Silhouette, TakesOnlyTheRimWithTheBackgroundBeyondIt) {
  const auto rim = RimOfBall([](double turn) {
    return turn < 1 ? Beyond::kUnknown : turn < 2 ? Beyond::kLevel : Beyond::kFarther;
  });
  const Silhouette silhouette = TraceSilhouette(BallPoints(), rim, kOrigin, {}, {});
  const auto farther = std::count_if(rim.begin(), rim.end(),
                                     [](const auto& r) { return r.beyond == Beyond::kFarther; });
  EXPECT_EQ(silhouette.rays_F.size, farther);
  EXPECT_NEAR(TotalWeight(silhouette.rays_F), static_cast<double>(farther) / 64, 1e-5);
  EXPECT_TRUE(silhouette.straights.empty());
  EXPECT_TRUE(silhouette.cuts.empty());
  for (int i = 0; i < silhouette.rays_F.size; ++i) {
    const Vector3d ray = silhouette.rays_F.at(i) / silhouette.rays_F.at(i).z();
    // Half a pixel outside the rim, on its side.
    EXPECT_NEAR(ray.head<2>().norm() * 525, 0.0499 / 0.8 * 525 + 0.5, 0.05);
    double turn = std::atan2(ray.y(), ray.x());
    if (turn < 0) turn += 2 * M_PI;
    EXPECT_GT(turn, 1.9);
  }
}

TEST(Silhouette, HasTheSameRaysWhicheverWayTheRimRuns) {
  auto rim = RimOfBall([](double) { return Beyond::kFarther; });
  const Silhouette there = TraceSilhouette(BallPoints(), rim, kOrigin, {}, {});
  std::reverse(rim.begin(), rim.end());
  const Silhouette back = TraceSilhouette(BallPoints(), rim, kOrigin, {}, {});
  ASSERT_EQ(there.rays_F.size, 64);
  ASSERT_EQ(back.rays_F.size, 64);
  for (int i = 0; i < 64; ++i) {
    EXPECT_LT((there.rays_F.at(i) - back.rays_F.at(63 - i)).norm(), 1e-6);
  }
}

TEST(Silhouette, KnowsTheSideThatIsHidden) {
  for (const Beyond hiding : {Beyond::kNearer, Beyond::kImageBorder}) {
    const auto rim = RimOfBall([&](double turn) {  // hidden towards +y
      return turn > 1 && turn < M_PI - 1 ? hiding : Beyond::kFarther;
    });
    const Silhouette silhouette = TraceSilhouette(BallPoints(), rim, kOrigin, {}, {});
    ASSERT_EQ(silhouette.cuts.size(), 1u);
    EXPECT_GT(silhouette.cuts[0].normal_F.y(), 0.99);
    EXPECT_TRUE(silhouette.cuts[0].rays.empty());
    EXPECT_NEAR(silhouette.cuts[0].width_rad, 0.0625 * 1.95, 0.01);
  }
  const auto all = RimOfBall([](double) { return Beyond::kNearer; });
  const Silhouette hidden = TraceSilhouette(BallPoints(), all, {}, {}, {});
  EXPECT_TRUE(hidden.cuts.empty());
  EXPECT_EQ(hidden.rays_F.size, 0);
}

TEST(Silhouette, IsEmptyWhereThereIsNothingToSee) {
  const PointList one{{0, 0, 0.8}};
  EXPECT_TRUE(TraceSilhouette({}, {}, kOrigin, {}, {}).straights.empty());
  EXPECT_EQ(TraceSilhouette({}, {}, kOrigin, {}, {}).rays_F.size, 0);
  EXPECT_TRUE(TraceSilhouette(one, {}, kOrigin, {}, {}).straights.empty());
  // The viewpoint in the middle of the points, on one of them, and with some behind it.
  EXPECT_EQ(TraceSilhouette(BallPoints(), {}, {0, 0, 0.8}, {}, {}).rays_F.size, 0);
  EXPECT_EQ(TraceSilhouette(BallPoints(), {}, BallPoints()[7], {}, {}).rays_F.size, 0);
  EXPECT_EQ(TraceSilhouette(BallPoints(), {}, {0, 0, 0.79}, {}, {}).rays_F.size, 0);
  EXPECT_EQ(TraceSilhouette(BallPoints(), {}, kOrigin, {}, {.most_rays = 0}).rays_F.size, 0);
  auto rim = RimOfBall([](double) { return Beyond::kFarther; });
  rim[3].point.z() = -1;  // behind
  EXPECT_EQ(TraceSilhouette(BallPoints(), rim, kOrigin, {}, {}).rays_F.size, 0);
  rim.resize(1);
  rim[0].point.z() = 0.8f;
  EXPECT_TRUE(
      std::isfinite(TotalWeight(TraceSilhouette(BallPoints(), rim, kOrigin, {}, {}).rays_F)));
}

TEST(Silhouette, IsFoundFromAnySide) {
  const TableView view = PixelViewOnTable(Ball());
  const int expected = TraceSilhouette(Widened(view.points_C), {}, kOrigin, {}, {}).rays_F.size;
  const Eigen::AngleAxisd turn(2.5, Vector3d(1, 2, 0).normalized());
  PointList turned;
  for (const auto& p : Widened(view.points_C)) turned.push_back(turn * p + Vector3d(1, 2, 3));
  const Silhouette silhouette = TraceSilhouette(turned, {}, Vector3d(1, 2, 3), {}, {});
  EXPECT_NEAR(silhouette.rays_F.size, expected, 60);
  EXPECT_GT(silhouette.rays_F.size, 30);
  const Vector3d middle = turn * view.shape_C.X_FO.translation();
  for (int i = 0; i < silhouette.rays_F.size; ++i) {
    EXPECT_NEAR(silhouette.rays_F.at(i).cross(middle).norm(), 0.05, 1.5 * kPixel_m);
  }
}

}  // namespace
}  // namespace beckon::pose
