// Objects of one superquadric and of several, hollow ones, and ones cut apart by occluders.
#include "services/pose/parts.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "services/pose/fit.h"
#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

using Eigen::Vector3d;

// An image of surfaces on a table, W being the table with z up, as a camera 0.8 m away and 40
// degrees above it has it: in each pixel the nearest point, with noise along the ray.
class Scene {
 public:
  Scene() {
    const double pitch = 40 * M_PI / 180, distance = 0.8;
    const Vector3d forward(0, std::cos(pitch), -std::sin(pitch)), right(1, 0, 0);
    Pose X_WC = Pose::Identity();
    X_WC.linear() << right, forward.cross(right), forward;
    X_WC.translation() = -distance * forward;
    X_CW_ = X_WC.inverse();
    table_C_ = {X_CW_.linear().col(2), X_WC.translation().z()};
  }

  void AddPoint(const Vector3d& p_W) {
    const Vector3d p = X_CW_ * p_W;
    const std::pair pixel(std::lround(kFocal * p.x() / p.z()), std::lround(kFocal * p.y() / p.z()));
    const auto [it, fresh] = nearest_.try_emplace(pixel, p);
    if (!fresh && p.z() < it->second.z()) it->second = p;
  }
  void AddSolid(const Superquadric& shape_W) {
    for (const Vector3d& p : SampleSurface(shape_W, 60000)) AddPoint(p);
    truth_C_.push_back(shape_W);
    truth_C_.back().X_FO = X_CW_ * shape_W.X_FO;
  }
  // Something in front of the pixels for which `hidden` is true; x to the right, y down, px.
  void Hide(const std::function<bool(long x, long y)>& hidden) {
    std::erase_if(nearest_,
                  [&](const auto& entry) { return hidden(entry.first.first, entry.first.second); });
  }

  PointList Points(double sigma_m = 0.0015) const {
    std::mt19937 engine(1);
    std::normal_distribution<double> noise(0, sigma_m);
    PointList points;
    for (const auto& [pixel, p] : nearest_) points.push_back(p * (1 + noise(engine) / p.z()));
    return points;
  }
  FitResult FitAll(const FitConfig& config = {}) const {
    std::vector<Eigen::Vector3f> points;
    for (const Vector3d& p : Points()) points.push_back(p.cast<float>());
    return Fit({points, table_C_}, config);
  }
  const Plane& table_C() const { return table_C_; }
  const std::vector<Superquadric>& truth_C() const { return truth_C_; }
  Vector3d InWorld(const Superquadric& part_C) const {
    return X_CW_.inverse() * part_C.X_FO.translation();
  }

 private:
  static constexpr double kFocal = 525;  // px
  Pose X_CW_;
  Plane table_C_;
  std::vector<Superquadric> truth_C_;
  std::map<std::pair<long, long>, Vector3d> nearest_;
};

Superquadric Can(double radius, double height, double foot = 0) {
  return MakeShape({radius, radius, height / 2}, 0.1, 1, {0, 0, foot + height / 2});
}

Superquadric Handle() { return MakeShape({0.018, 0.006, 0.03}, 0.3, 0.3, {0.057, 0, 0.05}); }

Scene Mug() {
  Scene scene;
  scene.AddSolid(Can(0.042, 0.1));
  scene.AddSolid(Handle());
  return scene;
}

Scene Bottle() {
  Scene scene;
  scene.AddSolid(Can(0.035, 0.14));
  scene.AddSolid(Can(0.013, 0.06, 0.14));
  return scene;
}

// The walls of a round vessel, `radius(z)` wide, and its floor, seen from outside and inside.
Scene Vessel(double height, const std::function<double(double)>& radius) {
  Scene scene;
  for (double z = 0.001; z < height; z += 0.0007) {
    for (double turn = 0; turn < 2 * M_PI; turn += 0.008) {
      const Vector3d out(std::cos(turn), std::sin(turn), 0);
      scene.AddPoint(radius(z) * out + Vector3d(0, 0, z));
      if (z > 0.003) scene.AddPoint((radius(z) - 0.003) * out + Vector3d(0, 0, z));
    }
  }
  for (double r = 0; r < radius(0.003); r += 0.0007) {
    for (double turn = 0; turn < 2 * M_PI; turn += 0.02) {
      scene.AddPoint({r * std::cos(turn), r * std::sin(turn), 0.003});
    }
  }
  return scene;
}

double UnionDistance(const std::vector<Superquadric>& parts, const PointList& points) {
  double sum = 0;
  for (const Vector3d& p : points) {
    double nearest = 1e9;
    for (const Superquadric& part : parts) nearest = std::min(nearest, RadialDistance(part, p));
    sum += nearest / static_cast<double>(points.size());
  }
  return sum;
}

TEST(PartsTest, FindTheHandleOfAMug) {
  const Scene scene = Mug();
  const FitResult result = scene.FitAll();
  ASSERT_EQ(result.parts.size(), 2u);
  const Vector3d body = scene.InWorld(result.parts[0]), handle = scene.InWorld(result.parts[1]);
  EXPECT_LT((body - Vector3d(0, 0, 0.05)).norm(), 0.004);
  EXPECT_LT((handle - Handle().X_FO.translation()).norm(), 0.012);
}

TEST(PartsTest, FindTheNeckOfABottle) {
  const Scene scene = Bottle();
  const FitResult result = scene.FitAll();
  ASSERT_EQ(result.parts.size(), 2u);
  const Vector3d body = scene.InWorld(result.parts[0]), neck = scene.InWorld(result.parts[1]);
  EXPECT_LT((body - Vector3d(0, 0, 0.07)).norm(), 0.006);
  EXPECT_LT((neck - Vector3d(0, 0, 0.17)).norm(), 0.01);
  EXPECT_LT(result.parts[1].semi_axes.minCoeff(), 0.02);
}

TEST(PartsTest, TogetherExplainThePointsBetterThanOneShape) {
  const Scene mug = Mug(), bottle = Bottle();
  // A handle is a few pixels wide and its thickness hardly seen: what is gained is little, but
  // gained.
  const FitResult with_handle = mug.FitAll();
  EXPECT_LT(UnionDistance(with_handle.parts, mug.Points()),
            0.95 * with_handle.mean_radial_distance_m);
  // A neck is seen well. The noise keeps the points off the true surface too: what counts is the
  // excess.
  const FitResult with_neck = bottle.FitAll();
  const double noise = UnionDistance(bottle.truth_C(), bottle.Points());
  EXPECT_LT(UnionDistance(with_neck.parts, bottle.Points()) - noise,
            0.1 * (with_neck.mean_radial_distance_m - noise));
}

TEST(PartsTest, AreNotFoundWhereOneShapeDoes) {
  const std::vector<Superquadric> shapes{
      MakeShape({0.05, 0.03, 0.08}, 0.1, 0.1, {0, 0, 0.08}, {0, 0, 0.5}), Can(0.035, 0.12),
      MakeShape({0.09, 0.07, 0.03}, 0.1, 0.1, {0, 0, 0.03}, {0, 0, 1}),
      MakeShape({0.04, 0.05, 0.06}, 1, 1, {0, 0, 0.06})};
  for (const Superquadric& shape : shapes) {
    Scene scene;
    scene.AddSolid(shape);
    EXPECT_TRUE(scene.FitAll().parts.empty()) << shape.semi_axes.transpose();
  }
}

TEST(PartsTest, AreNotTheTwoSidesOfAnOccluder) {
  Scene scene;
  scene.AddSolid(MakeShape({0.08, 0.03, 0.08}, 0.1, 0.1, {0, 0, 0.08}, {0, 0, 0.3}));
  scene.Hide([](long x, long) { return std::abs(x) < 14; });
  EXPECT_TRUE(scene.FitAll().parts.empty());
}

TEST(PartsTest, AreNotABoxWithHiddenCorners) {
  Scene scene;
  scene.AddSolid(MakeShape({0.07, 0.03, 0.09}, 0.1, 0.1, {0, 0, 0.09}, {0, 0, 0.2}));
  scene.Hide([](long x, long y) { return y < -40 && std::abs(x) > 22; });
  EXPECT_TRUE(scene.FitAll().parts.empty());
}

TEST(PartsTest, AreTheFlushNeckOfAFlatBottleWhereTheImageShowsItsOutline) {
  Scene scene;
  scene.AddSolid(MakeShape({0.04, 0.02, 0.055}, 0.1, 0.1, {0, 0, 0.055}));
  scene.AddSolid(MakeShape({0.014, 0.02, 0.03}, 0.1, 0.1, {0, 0, 0.14}));
  const PointList points = scene.Points();
  const FitResult alone = scene.FitAll();
  const auto parts_with = [&](Beyond beyond) {
    std::vector<RimPoint> rim;
    for (const Vector3d& p : points) rim.push_back({p.cast<float>(), beyond});
    return FindParts(points, scene.table_C(), Vector3d::Zero(), rim, alone.shape, {}, {});
  };
  EXPECT_EQ(parts_with(Beyond::kFarther).size(), 2u);
  EXPECT_TRUE(parts_with(Beyond::kNearer).empty());
}

TEST(PartsTest, AreNotTheInsidesOfVessels) {
  const Scene cup = Vessel(0.1, [](double) { return 0.04; });
  EXPECT_TRUE(cup.FitAll().parts.empty());
  const Scene bowl = Vessel(0.06, [](double z) { return 0.035 + 0.045 * std::sqrt(z / 0.06); });
  EXPECT_TRUE(bowl.FitAll().parts.empty());
}

TEST(PartsTest, LeaveTheSingleShapeAsItIs) {
  FitConfig alone;
  alone.parts.most_parts = 1;
  const FitResult with = Mug().FitAll(), without = Mug().FitAll(alone);
  EXPECT_TRUE(without.parts.empty());
  EXPECT_EQ(with.shape.semi_axes, without.shape.semi_axes);
  EXPECT_TRUE(with.shape.X_FO.matrix() == without.shape.X_FO.matrix());
  EXPECT_EQ(with.mean_radial_distance_m, without.mean_radial_distance_m);
}

TEST(PartsTest, AreTheSameEveryTime) {
  const Scene scene = Mug();
  const std::vector<Superquadric> first = scene.FitAll().parts, second = scene.FitAll().parts;
  ASSERT_EQ(first.size(), second.size());
  for (size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].semi_axes, second[i].semi_axes);
    EXPECT_EQ(first[i].epsilon, second[i].epsilon);
    EXPECT_TRUE(first[i].X_FO.matrix() == second[i].X_FO.matrix());
  }
}

TEST(PartsTest, ComeOutFiniteWhereTheCameraIsAmongThePointsOrThePointsCoincide) {
  const PointList points = Mug().Points();
  const Superquadric single = MakeShape({0.03, 0.03, 0.03}, 0.5, 0.5, points[points.size() / 2]);
  const PointList same(200, points[0]);
  for (const PointList& cloud : {points, same}) {
    for (const Vector3d& viewpoint : {Vector3d(0, 0, 0), points[0]}) {
      for (const Superquadric& part : FindParts(cloud, {}, viewpoint, {}, single, {}, {})) {
        EXPECT_TRUE(part.semi_axes.allFinite() && part.X_FO.matrix().allFinite());
      }
    }
  }
}

}  // namespace
}  // namespace beckon::pose
