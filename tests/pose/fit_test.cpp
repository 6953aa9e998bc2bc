// All fitting methods on known shapes, noise, degenerate and hostile clouds.
#include "services/pose/fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using ::testing::HasSubstr;

FitConfig With(Method method) {
  FitConfig config;
  config.method = method;
  return config;
}

class FitTest : public ::testing::TestWithParam<Method> {
 protected:
  const FitConfig config_ = With(GetParam());

  FitResult FitPoints(const std::vector<Vector3f>& points) const {
    return Fit({points, {}}, config_);
  }
};

INSTANTIATE_TEST_SUITE_P(Methods, FitTest,
                         ::testing::Values(Method::kAdaptive, Method::kMultiscale, Method::kClassic,
                                           Method::kHierarchical),
                         [](const auto& instance) { return std::string(Name(instance.param)); });

void ExpectFinite(const FitResult& result) {
  EXPECT_TRUE(result.shape.semi_axes.allFinite() && result.shape.X_FO.matrix().allFinite());
  EXPECT_GT(result.shape.semi_axes.minCoeff(), 0);
  EXPECT_TRUE(result.shape.epsilon.allFinite() && result.covariance.allFinite());
  EXPECT_TRUE(std::isfinite(result.mean_radial_distance_m));
}

const std::vector<Superquadric>& KnownShapes() {
  static const std::vector<Superquadric> shapes{
      MakeShape({0.04, 0.06, 0.09}, 1, 1, {0.1, -0.2, 0.9}),
      MakeShape({0.03, 0.05, 0.08}, 0.2, 0.2, {0, 0, 0.8}, {0.3, 0.4, 0.5}),
      MakeShape({0.035, 0.035, 0.08}, 0.2, 1, {-0.1, 0.1, 1}, {1.2, -0.3, 0.1}),
      MakeShape({0.03, 0.05, 0.08}, 0.5, 0.8, {-0.1, 0.1, 0.7}, {0.2, 0.1, 2}),
  };
  return shapes;
}

TEST_P(FitTest, RecoversKnownShapesFromTheirWholeSurface) {
  for (const Superquadric& truth : KnownShapes()) {
    const FitResult result = FitPoints(WholeSurface(truth, 1500));
    EXPECT_TRUE(result.converged) << result.reason;
    EXPECT_LT((result.shape.X_FO.translation() - truth.X_FO.translation()).norm(), 0.0005);
    EXPECT_LT(ShapeDifference(result.shape, truth), 0.0007);
    EXPECT_NEAR(Volume(result.shape) / Volume(truth), 1, 0.04);
    EXPECT_EQ(result.points_used, 1500);
  }
}

TEST_P(FitTest, WithstandsNoise) {
  for (const Superquadric& truth : KnownShapes()) {
    const auto points = WholeSurface(truth, 1500, 0.002);
    const FitResult result = FitPoints(points);
    EXPECT_TRUE(result.converged) << result.reason;
    EXPECT_LT((result.shape.X_FO.translation() - truth.X_FO.translation()).norm(), 0.002);
    EXPECT_LT(ShapeDifference(result.shape, truth), 0.003);
    EXPECT_NEAR(result.mean_radial_distance_m, MeanRadialDistance(truth, points), 0.0005);
  }
}

TEST_P(FitTest, MovesWithTheCloud) {
  const Superquadric truth = KnownShapes()[3];
  const FitResult here = FitPoints(WholeSurface(truth, 1000));
  Superquadric moved = truth;
  Pose X = Pose::Identity();
  X.linear() = Eigen::AngleAxisd(0.8, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  X.translation() = Vector3d(0.4, -0.3, 0.6);
  moved.X_FO = X * truth.X_FO;
  const FitResult there = FitPoints(WholeSurface(moved, 1000));
  Superquadric expected = here.shape;
  expected.X_FO = X * here.shape.X_FO;
  EXPECT_LT(ShapeDifference(there.shape, expected), 0.0007);
}

TEST_P(FitTest, IsDeterministic) {
  const auto points = WholeSurface(KnownShapes()[1], 800, 0.001);
  const FitResult a = FitPoints(points), b = FitPoints(points);
  EXPECT_EQ(a.shape.X_FO.matrix(), b.shape.X_FO.matrix());
  EXPECT_EQ(a.shape.semi_axes, b.shape.semi_axes);
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.iterations, b.iterations);
}

TEST_P(FitTest, LeavesOutPointsThatAreNotFinite) {
  auto points = WholeSurface(KnownShapes()[0], 500);
  const FitResult clean = FitPoints(points);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInf = std::numeric_limits<float>::infinity();
  points.insert(points.begin(), {kNan, kNan, kNan});
  points.insert(points.begin() + 100, {0, kInf, 0});
  points.push_back({0, 0, -kInf});
  const FitResult dirty = FitPoints(points);
  EXPECT_EQ(dirty.points_used, 500);
  EXPECT_EQ(dirty.shape.semi_axes, clean.shape.semi_axes);
}

TEST_P(FitTest, SaysWhyItDoesNotFitTooFewPoints) {
  for (int count : {0, 1, 5, 19}) {
    const FitResult result = FitPoints(WholeSurface(KnownShapes()[0], count));
    EXPECT_FALSE(result.converged);
    EXPECT_THAT(result.reason, HasSubstr(count == 0 ? "no finite points" : "fewer than 20"));
    ExpectFinite(result);
  }
  const FitResult all_nan = FitPoints(std::vector<Vector3f>(100, Vector3f::Constant(NAN)));
  EXPECT_THAT(all_nan.reason, HasSubstr("no finite points"));
  ExpectFinite(all_nan);
}

TEST_P(FitTest, SaysWhyItDoesNotFitPointsWithoutShape) {
  std::vector<Vector3f> line, plane, point(100, Vector3f(0.1f, 0.2f, 0.8f));
  for (int i = 0; i < 100; ++i) {
    line.emplace_back(0.001f * i, 0.002f * i, 0.8f);
    plane.emplace_back(0.01f * (i % 10), 0.01f * (i / 10), 0.8f);
  }
  EXPECT_THAT(FitPoints(line).reason, HasSubstr("on a line"));
  EXPECT_THAT(FitPoints(plane).reason, HasSubstr("on a plane"));
  EXPECT_THAT(FitPoints(point).reason, HasSubstr("less than"));
  for (const auto& points : {line, plane, point}) {
    EXPECT_FALSE(FitPoints(points).converged);
    ExpectFinite(FitPoints(points));
  }
}

TEST_P(FitTest, SuspectsMillimetres) {
  auto points = WholeSurface(KnownShapes()[0], 500);
  for (auto& p : points) p *= 1000;
  const FitResult result = FitPoints(points);
  EXPECT_FALSE(result.converged);
  EXPECT_THAT(result.reason, HasSubstr("millimetres"));
  ExpectFinite(result);
}

TEST_P(FitTest, DoesNotClaimToFitWhatIsNoSuperquadric) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> unit(-0.5f, 0.5f);
  std::vector<Vector3f> cube;  // filled, not a surface
  for (int i = 0; i < 2000; ++i) cube.emplace_back(unit(engine), unit(engine), 1.5f + unit(engine));
  const FitResult result = FitPoints(cube);
  EXPECT_FALSE(result.converged);
  EXPECT_FALSE(result.reason.empty());
  ExpectFinite(result);
}

TEST_P(FitTest, CovarianceKnowsWhatIsNotSeen) {
  // The turn of a cylinder about its axis is undetermined, its tilt is not.
  const Superquadric can = MakeShape({0.04, 0.04, 0.08}, 0.2, 1, {0, 0, 0.8});
  const FitResult result = FitPoints(WholeSurface(can, 1500, 0.001));
  EXPECT_TRUE(result.covariance.isApprox(result.covariance.transpose()));
  EXPECT_GT(result.covariance(5, 5), 100 * result.covariance(3, 3));
  EXPECT_LT(result.covariance(3, 3), 1e-4);
  EXPECT_GT(result.covariance(0, 0), 0);
  EXPECT_LT(result.covariance(0, 0), 1e-6);
}

TEST(Multiscale, ReportsItsLevels) {
  const FitResult result =
      Fit({WholeSurface(KnownShapes()[0], 1500), {}}, With(Method::kMultiscale));
  EXPECT_GE(result.iterations.size(), 2u);
  EXPECT_LE(result.iterations.size(), 4u);
}

TEST(Multiscale, FindsTheAxisOrder) {
  // The round axis is the longest, the middle and the shortest in turn.
  for (const Vector3d& a : {Vector3d(0.03, 0.03, 0.09), Vector3d(0.06, 0.06, 0.03)}) {
    const Superquadric can = MakeShape(a, 0.2, 1, {0, 0, 0.8}, {0.5, 0.2, 0.1});
    const FitResult result = Fit({WholeSurface(can, 1500), {}}, With(Method::kMultiscale));
    EXPECT_GT(std::abs(result.shape.X_FO.linear().col(2).dot(can.X_FO.linear().col(2))), 0.999);
    EXPECT_NEAR(result.shape.epsilon[1], 1, 0.05);
  }
}

TEST(Adaptive, FindsTheHiddenHalfOnATable) {
  const std::vector<Superquadric> shapes{
      MakeShape({0.04, 0.06, 0.09}, 0.1, 0.1, {0, 0, 0.09}, {0, 0, 0.5}),
      MakeShape({0.035, 0.035, 0.06}, 0.1, 1, {0, 0, 0.06}),
      MakeShape({0.04, 0.05, 0.06}, 1, 1, {0, 0, 0.06}, {0, 0, 0.5}),
      MakeShape({0.03, 0.03, 0.08}, 0.1, 1, {0, 0, 0.03}, {0, M_PI / 2, 0}),
  };
  for (const Superquadric& shape_W : shapes) {
    const TableView view = ViewOnTable(shape_W, 3000, 0.0015);
    const FitResult result = Fit({view.points_C, view.table_C}, With(Method::kAdaptive));
    EXPECT_TRUE(result.converged) << result.reason;
    const Vector3d off = result.shape.X_FO.translation() - view.shape_C.X_FO.translation();
    EXPECT_LT(off.norm(), 0.0015) << "semi-axes " << shape_W.semi_axes.transpose();
    EXPECT_LT(ShapeDifference(result.shape, view.shape_C), 0.0015);
  }
}

TEST(Adaptive, StandsOnTheTableItIsTold) {
  const Superquadric box = MakeShape({0.04, 0.06, 0.09}, 0.1, 0.1, {0, 0, 0.09}, {0, 0, 0.5});
  const TableView view = ViewOnTable(box, 2000, 0.0015);
  const FitResult result = Fit({view.points_C, view.table_C}, With(Method::kAdaptive));
  const double foot = view.table_C.Distance(result.shape.X_FO.translation()) -
                      HalfWidth(result.shape, view.table_C.normal);
  EXPECT_NEAR(foot, 0, 0.001);
}

TEST(Adaptive, AdmitsThatItDoesNotSeeTheFoot) {
  const Superquadric box = MakeShape({0.04, 0.06, 0.09}, 0.1, 0.1, {0, 0, 0.09}, {0, 0, 0.5});
  TableView view = ViewOnTable(box, 3000, 0.0015);
  EXPECT_FALSE(Fit({view.points_C, view.table_C}, With(Method::kAdaptive)).ambiguous);
  std::erase_if(view.points_C,
                [&](const Vector3f& p) { return view.table_C.Distance(p.cast<double>()) < 0.08; });
  const FitResult result = Fit({view.points_C, view.table_C}, With(Method::kAdaptive));
  EXPECT_TRUE(result.ambiguous);
  ExpectFinite(result);
}

TEST(Methods, AreKnownByNameAndOthersRefusedWithTheList) {
  EXPECT_EQ(*ParseMethod("adaptive"), Method::kAdaptive);
  EXPECT_EQ(*ParseMethod("multiscale"), Method::kMultiscale);
  EXPECT_EQ(*ParseMethod("classic"), Method::kClassic);
  EXPECT_EQ(*ParseMethod("hierarchical"), Method::kHierarchical);
  const auto unknown = ParseMethod("guess");
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message, HasSubstr("'guess'"));
  EXPECT_THAT(unknown.error().message, HasSubstr("adaptive, multiscale, classic, hierarchical"));
}

}  // namespace
}  // namespace beckon::pose
