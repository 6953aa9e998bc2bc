// The adaptive fit where a part of the object is cut off, hidden or hardly seen.
#include "services/pose/fit_adaptive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "services/pose/fit.h"
#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

Superquadric Box() { return MakeShape({0.04, 0.06, 0.09}, 0.1, 0.1, {0, 0, 0.09}, {0, 0, 0.5}); }

double OffBy(const FitResult& result, const Superquadric& truth) {
  return (result.shape.X_FO.translation() - truth.X_FO.translation()).norm();
}

// Lying on its side, across the line of sight.
Superquadric LyingCan() {
  return MakeShape({0.03, 0.03, 0.08}, 0.1, 1, {0, 0, 0.03}, {0, M_PI / 2, 0});
}
Superquadric LongBox() {
  return MakeShape({0.08, 0.03, 0.04}, 0.1, 0.1, {0, 0, 0.04}, {0, 0, 0.4});
}

TEST(AdaptiveFit, CompletesWhatAnObliqueLineCutsOff) {
  FitConfig guessing, trusting;
  trusting.adaptive.cut_hypotheses = false;
  for (const Superquadric& shape_W : {LyingCan(), LongBox()}) {
    double guessing_m = 0, trusting_m = 0;
    for (const double angle : {-0.3, 0.2, M_PI + 0.2}) {
      TableView view = PixelViewOnTable(shape_W, 0.0015);
      CutAway(angle, 0.33, view.points_C);
      const FitInput input{view.points_C, view.table_C};
      const double a = OffBy(Fit(input, guessing), view.shape_C);
      const double b = OffBy(Fit(input, trusting), view.shape_C);
      guessing_m += a;
      trusting_m += b;
    }
    EXPECT_LT(guessing_m, 0.8 * trusting_m);
  }
}

// The points of the first object of a scene.
std::vector<Vector3f> PointsOfFirst(const TableScene& scene) {
  std::vector<Vector3f> points;
  for (int v = 0; v < scene.image.height; ++v) {
    for (int u = 0; u < scene.image.width; ++u) {
      const size_t i = static_cast<size_t>(v * scene.image.width + u);
      if (scene.labels[i] != 1) continue;
      const double depth_m = static_cast<double>(scene.image.depth_m[i]);
      points.push_back(scene.image.intrinsics.Unproject(u, v, depth_m).cast<float>());
    }
  }
  return points;
}

TEST(AdaptiveFit, CompletesWhatTheRimTellsIsHidden) {
  FitConfig trusting;
  trusting.adaptive.cut_hypotheses = false;
  trusting.adaptive.pixel_rad = 1 / 262.5;
  for (const Superquadric& shape_W : {LyingCan(), LongBox()}) {
    double told_m = 0, blind_m = 0;
    for (const double side : {-1.0, 1.0}) {
      // A box in front of one end.
      const Superquadric occluder =
          MakeShape({0.035, 0.02, 0.1}, 0.1, 0.1, {side * 0.06, -0.15, 0.1}, {0, 0, 0.2});
      const TableScene scene = SceneOnTable({shape_W, occluder}, 0.001);
      const std::vector<Vector3f> points = PointsOfFirst(scene);
      const auto rim = FindRims(scene.image, scene.labels, 2, scene.table_C)[0];
      ASSERT_TRUE(std::any_of(rim.begin(), rim.end(),
                              [](const auto& r) { return r.beyond == Beyond::kNearer; }));
      const FitInput blind{points, scene.table_C};
      const FitInput told{points, scene.table_C, Vector3d::Zero(), rim};
      const double a = OffBy(Fit(told, trusting), scene.shapes_C[0]);
      const double b = OffBy(Fit(blind, trusting), scene.shapes_C[0]);
      told_m += a;
      blind_m += b;
    }
    EXPECT_LT(told_m, 0.8 * blind_m);
  }
}

// Height above the table of the highest point.
double TopOf(const FitResult& result, const Plane& table_C) {
  double top_m = 0;
  for (const auto& p : SampleSurface(result.shape, 2000)) {
    top_m = std::max(top_m, table_C.Distance(p));
  }
  return top_m;
}

TEST(AdaptiveFit, EndsWhereTheRimOfAnOpenBowlIsSeen) {
  FitConfig config;
  config.adaptive.cut_hypotheses = false;
  for (const double height_m : {0.05, 0.07, 0.08}) {
    const TableView bowl = BowlOnTable(0.08, height_m, 0.001);
    const FitResult result = Fit({bowl.points_C, bowl.table_C}, config);
    EXPECT_LT(TopOf(result, bowl.table_C), height_m + 0.05);
    EXPECT_LT(OffBy(result, bowl.shape_C), 0.03);
  }
}

TEST(AdaptiveFit, TakesNoThingForASheetOfWhichOneFaceIsSeen) {
  // Straight from the front, the depth is hidden.
  FitConfig config;
  config.adaptive.cut_hypotheses = false;
  std::vector<Vector3f> face;
  std::mt19937 engine(1);
  std::normal_distribution<float> noise(0, 0.001f);
  for (float x = -0.06f; x <= 0.06f; x += 0.0015f) {
    for (float y = -0.09f; y <= 0.09f; y += 0.0015f) face.emplace_back(x, y, 0.8f + noise(engine));
  }
  const Plane table{-Vector3d::UnitY(), 0.09};
  const FitResult result = Fit({face, table}, config);
  EXPECT_GT(result.shape.semi_axes.minCoeff(), 0.01);
}

TEST(AdaptiveFit, IsLessSureAlongTheLineOfSight) {
  // Without a table, seen from the front: where the back is, only the sides tell.
  for (const auto& [e1, turn] : {std::pair(0.1, 0.2), {0.1, 0.3}, {1.0, 0.2}, {1.0, 0.3}}) {
    const Superquadric shape = MakeShape({0.04, 0.05, 0.06}, e1, e1, {0, 0, 0.8}, {turn, turn, 0});
    std::mt19937 engine(1);
    std::normal_distribution<float> noise(0, 0.001f);
    std::vector<Vector3f> points;
    for (const auto& p : SampleSurface(shape, 12000)) {
      const Vector3d normal = shape.X_FO.linear() * NormalAt(shape, shape.X_FO.inverse() * p);
      if (normal.dot(p.normalized()) > -0.14) continue;
      const Vector3f q = p.cast<float>();
      points.push_back(q * (1 + noise(engine) / q.z()));
    }
    const FitResult result = Fit({points, {}}, {});
    const double along_m = std::sqrt(result.covariance(2, 2));
    const double across_m = std::sqrt(std::max(result.covariance(0, 0), result.covariance(1, 1)));
    EXPECT_GT(along_m, 1.5 * across_m) << "epsilon " << e1 << ", turned by " << turn;
  }
}

TEST(AdaptiveFit, GivesTheSameBytesEveryTime) {
  const TableView view = PixelViewOnTable(Box(), 0.002);
  for (const auto& table : {std::optional<Plane>(view.table_C), std::optional<Plane>()}) {
    const FitInput input{view.points_C, table};
    const FitResult a = Fit(input, {}), b = Fit(input, {});
    const auto same = [](const auto& x, const auto& y) {
      return std::memcmp(x.data(), y.data(), sizeof(double) * static_cast<size_t>(x.size())) == 0;
    };
    EXPECT_TRUE(same(a.shape.X_FO.matrix(), b.shape.X_FO.matrix()));
    EXPECT_TRUE(same(a.shape.semi_axes, b.shape.semi_axes));
    EXPECT_TRUE(same(a.shape.epsilon, b.shape.epsilon));
    EXPECT_TRUE(same(a.covariance, b.covariance));
    EXPECT_EQ(std::memcmp(&a.mean_radial_distance_m, &b.mean_radial_distance_m, sizeof(double)), 0);
    EXPECT_EQ(a.iterations, b.iterations);
    EXPECT_EQ(a.ambiguous, b.ambiguous);
  }
}

}  // namespace
}  // namespace beckon::pose
